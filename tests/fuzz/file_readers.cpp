// Readers of the product's own formats: what users write, and what it reads back of its own. Those
// of a search: search_readers.cpp.
#include <optional>

#include "fuzz/readers.hpp"
#include "fuzz/repaired.hpp"
#include "io/file_digest.hpp"
#include "io/poses_csv.hpp"
#include "io/table.hpp"
#include "io/time_text.hpp"
#include "io/trajectory_format.hpp"
#include "io/units.hpp"
#include "jobs/checkpoint.hpp"
#include "lilytank/bodies.hpp"
#include "lilytank/experiment.hpp"
#include "lilytank/flow_estimate.hpp"
#include "lilytank/flow_field.hpp"
#include "lilytank/kinetics.hpp"
#include "lilytank/optimize.hpp"
#include "lilytank/run.hpp"
#include "lilytank/study.hpp"
#include "lilytank/target.hpp"
#include "recording/event_log.hpp"
#include "study/kept_rows.hpp"
#include "study/row_text.hpp"
#include "study/study_record.hpp"
#include "text/number.hpp"

namespace lilytank::fuzz {
namespace {

const std::string kRules =
    "lilytank ruleset 1\nname pair\nhops counter-clockwise\ntarget\n  ##\nend\n"
    "join: (0,0) (0,0) -> (1,1)-(2,1)  p=1\npart: (1,1)-(2,1) -> (0,0) (0,0)  p=0.5\n";
const std::string kTank =
    "title = \"t\"\n[run]\nduration = \"0.5 s\"\n[tank]\nradius = \"16 cm\"\n[module]\ncount = 2\n"
    "[flow]\nsource = \"still\"\n[start]\nradius = 0.12\nfile = \"start.csv\"\n[ruleset]\nfile = "
    "\"pair.rules\"\n";
const std::string kScenario =
    kTank +
    "[rules]\npart.p = 0.1\n[output]\nrate = 4\ntrajectory = \"csv\"\n[control]\nmessage_loss = "
    "0.1\n"
    "[forces.body_force]\nforce_x = \"1.2 mN\"\n"
    "[[command]]\nat = 1\ndo = \"ruleset\"\nfile = \"pair.rules\"\nmodules = [1]\n";
const std::string kPoses = "id,x,y,theta\n0,0.05,0,0\n1,-0.05,0.02,1.5\n";
const std::string kFlow =
    "ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,measured\n"
    "0,0,-0.1,-0.1,0.01,0,0.001,0.002,1\n1,0,0.1,-0.1,0.01,0.02,0.001,0.002,1\n"
    "0,1,-0.1,0.1,0.01,-0.01,0,0.002,1\n1,1,0.1,0.1,0,0,0,0,0\n";
const std::string kStudy =
    "[study]\nname = \"pairs\"\nscenario = \"tank.toml\"\nreplicates = 2\nseed = 3\n"
    "[[axis]]\npath = \"rules.part.p\"\nvalues = [0, 0.25, \"50 %\"]\n"
    "[[axis]]\npath = \"flow.K_v\"\nfrom = 1\nto = 2\ncount = 2\n";
const std::string kOptimize =
    "[optimize]\nname = \"pair\"\nscenario = [\"tank.toml\", \"stirred.toml\"]\nfitness = "
    "\"full_yield_time\"\n"
    "evaluations = 60\nfinal_evaluations = 20\n"
    "[[parameter]]\npath = \"rules.part.p\"\nlow = 1e-5\nhigh = 1\nscale = \"log\"\n"
    "[agitation]\nkind = \"schedule\"\nlow = \"40 %\"\nhigh = \"90 %\"\n"
    "[compare]\nreplicates = 2\nseed = 4\n";
const std::string kExperiment =
    "base = \"tank.toml\"\n[experiment]\nname = \"two\"\n[[recording]]\nfile = \"tracks.csv\"\n"
    "format = \"table\"\ncolumns = {frame = \"f\", id = \"id\", x = \"x\", y = \"y\"}\nrate = 30\n"
    "latches = \"off\"\nchecks = {longest_gap = \"0.1 s\", outside = \"split\"}\n";
const std::string kBodies =
    "[experiment]\nname = \"falls\"\nbody = \"point\"\ndimensions = 1\nnoise = \"2 mm\"\n"
    "[baseline]\ngravity = 9.81\nlinear_drag = \"fit\"\n"
    "[[recording]]\nfile = \"falls.csv\"\ntime = \"t\"\nbody = \"ball\"\nrun = \"drop\"\nx = "
    "\"h\"\n"
    "mass = {a = 0.18, b = \"320 g\"}\nradius = [\"10 mm\"]\nscale = \"1 cm\"\ndrivers = [\"w\"]\n";

std::string fall_rows() {
  std::string out = "t,ball,drop,h,w\n";
  for (const char* ball : {"a", "b"}) {
    for (int k = 0; k < 10; ++k) {
      out +=
          std::to_string(0.1 * k) + "," + ball + ",1," + std::to_string(50 - 0.05 * k * k) + ",2\n";
    }
  }
  return out;
}

std::string track_rows() {
  std::string out = "f,id,x,y\n";
  for (int f = 0; f < 12; ++f) {
    out += std::to_string(f) + ",1,0.0" + std::to_string(10 + f) + ",0.01\n";
  }
  return out;
}

/// Files beside the one that is damaged, and one finished run.
struct Around {
  Scenario scenario;
  std::optional<Study> study;
  RunRow row;
  Around() {
    write_scratch("pair.rules", kRules), write_scratch("start.csv", kPoses);
    write_scratch("tracks.csv", track_rows()), write_scratch("falls.csv", fall_rows());
    write_scratch("stirred.toml", "flow.source = \"tank\"\n");
    scenario = load_scenario({write_scratch("tank.toml", kTank)}, {"output.trajectory=csv"});
    study.emplace(write_scratch("pairs.toml", kStudy));
    RunOptions options;
    options.out = scratch() + "/run";
    run(scenario, options);
    write_scratch("run/checkpoint.bin", "of another version");  // or its hashes refuse every damage
    row.replicate = 1, row.duration = 0.5, row.possible = 1;
    row.id = study->plan().id_of(0, 1), row.seed = study->plan().seed_of(1);
  }
};

const Around& around() {
  static const Around all;
  return all;
}

/// As it is, and with the hash on its first line made right, or damage would never come further.
bool read_checkpoint(std::string_view bytes) {
  around();
  std::string text(bytes);
  const auto read = [&] {
    return accepts("checkpoint.bin", [&] {
      const Checkpoint c = checkpoint_from(text, around().scenario.identity, "checkpoint.bin");
      AssemblyRecord record(around().scenario.model);
      try {
        record.restore(c.record, World(around().scenario.model, c.state));
      } catch (const InputError&) {  // it knows no file; the run names it
      }
    });
  };
  if (read()) return true;
  if (text.size() > 17) text.replace(0, 16, hash_of(std::string_view(text).substr(17)));
  return read();
}

template <class Load>
bool read_file(const std::string& name, std::string_view bytes, const Load& load) {
  around();
  const std::string file = write_scratch(name, bytes);
  return accepts(scratch(), [&] { load(file); });
}

bool read_scenario(std::string_view bytes) {
  return read_file("scenario.toml", bytes, [](const std::string& f) { load_scenario({f}, {}); });
}
bool read_set(std::string_view bytes) {
  around();
  return accepts("", [&] { load_scenario({scratch() + "/tank.toml"}, {std::string(bytes)}); });
}
bool read_study(std::string_view bytes) {
  return read_file("study.toml", bytes, [](const std::string& f) { Study study(f); });
}
bool read_study_record(std::string_view bytes) {
  return with_repair(bytes, with_right_last_line, [](std::string_view text) {
    return read_file("record.toml", text, [](const std::string& f) { read_plan(f); });
  });
}
bool read_optimize(std::string_view bytes) {
  return read_file("optimize.toml", bytes, [](const std::string& f) { Optimization what(f); });
}
bool read_experiment(std::string_view bytes) {
  return read_file("experiment.toml", bytes, [](const std::string& f) { load_experiment({f}); });
}
bool read_bodies(std::string_view bytes) {
  return read_file("bodies.toml", bytes, [](const std::string& f) { load_body_experiment(f); });
}
bool read_falls(std::string_view bytes) {
  write_scratch("of_table.toml", [] {
    std::string text = kBodies;
    return text.replace(text.find("falls.csv"), 9, "table.csv");
  }());
  return read_file("table.csv", bytes,
                   [](const std::string&) { load_body_experiment(scratch() + "/of_table.toml"); });
}
bool read_flow(std::string_view bytes) {
  return read_file("flow.csv", bytes,
                   [](const std::string& f) { read_flow_csv(f, Interpolation::bilinear, 0.16); });
}
bool read_ruleset_text(std::string_view bytes) {
  return accepts("pair.rules", [&] { parse_ruleset(std::string(bytes), "pair.rules"); });
}
bool read_drawing(std::string_view bytes) {
  return accepts("cross.txt", [&] {
    const Target target = parse_target(std::string(bytes), "cross.txt");
    demand(parse_target(to_text(target), "again").cells.size() == target.cells.size(),
           "a drawing reads back");
  });
}
bool read_poses(std::string_view bytes) {
  return accepts("start.csv", [&] { parse_poses(std::string(bytes), "start.csv"); });
}
bool read_binary(std::string_view bytes) {
  return with_repair(bytes, with_right_frames, [](std::string_view frames) {
    return accepts("trajectory.bin", [&] { parse_binary_trajectory(frames, "trajectory.bin"); });
  });
}
bool read_csv(std::string_view bytes) {
  return accepts("trajectory.csv", [&] { parse_csv_trajectory(bytes, "trajectory.csv"); });
}
bool read_metrics(std::string_view bytes) {
  return read_file("run/metrics.csv", bytes,
                   [](const std::string&) { load_run(scratch() + "/run"); });
}
bool read_events(std::string_view bytes) {
  return read_file("run/events.csv", bytes,
                   [](const std::string&) { rates_of_run(scratch() + "/run"); });
}
bool read_log(std::string_view bytes) {
  return read_file("log.csv", bytes, [](const std::string& file) { read_event_log(file); });
}
bool read_rates(std::string_view bytes) {
  return accepts("rates.csv", [&] { rate_table_from(std::string(bytes), "rates.csv"); });
}
bool read_measured(std::string_view bytes) {
  return with_repair(bytes, with_right_last_line, [](std::string_view text) {
    return accepts("world.csv", [&] { measured_world_from(std::string(text), "world.csv", 7); });
  });
}
bool read_truth(std::string_view bytes) {
  return read_file("truth.csv", bytes, [](const std::string& f) { read_flow_truth(f, 4); });
}

bool read_rows(std::string_view bytes) {
  around();
  return with_repair(bytes, with_right_rows, [](std::string_view text) {
    return accepts("rows.csv", [&] {
      bool foreign = false;
      rows_from(text, "rows.csv", around().study->plan(), foreign);
    });
  });
}
bool read_kept_rows(std::string_view bytes) {
  return with_repair(bytes, with_right_rows, [](std::string_view text) {
    return read_file("kept.rows", text, [](const std::string& f) {
      KeptRows kept;
      kept.file = f, kept.identity = 7, kept.threads = 1;
      kept_rows(kept, 2, [](int i) { return std::vector<double>{1.5, double(i)}; });
    });
  });
}

/// A line is one value: a quantity, a number, a date, a shard of a study.
bool read_values(std::string_view bytes) {
  const std::string text(bytes.substr(0, bytes.find('\n')));
  parse_number(text), parse_whole(text), parse_unit(text);
  TimeText().seconds(text, std::nullopt), TimeText().seconds(text, 0.001);
  const bool shard = accepts("--shard", [&] { shard_from(text); });
  accepts("environment", [&] {
    shard_of_environment([&](const char* name) {
      return std::string_view(name).starts_with("SLURM_") ? text.c_str() : nullptr;
    });
  });
  for (const char* unit : {"m", "s", "1", "rad", "1/s"}) {
    if (accepts("here.toml:2:1", [&] { read_quantity(text, unit, "x", {"here.toml", 2, 1}); }))
      return true;
  }
  return shard;
}

std::string checkpoint() {
  const World world(around().scenario.model, 1);
  AssemblyRecord record(around().scenario.model);
  Checkpoint c;
  c.state = world.state(), c.record = record.to_text();
  return to_bytes(c, around().scenario.identity);
}

std::string binary_trajectory() {
  const std::string file = scratch() + "/some.bin";
  World world(around().scenario.model, 1);
  const auto writer = open_trajectory(file, TrajectoryFormat::binary, around().scenario.model);
  writer->write(world, {});
  world.step();
  writer->write(world, {});
  writer->flush();
  return stored("some.bin");
}

std::string rate_rows() {
  return to_csv(rates_of_run(scratch() + "/run"));
}

}  // namespace

std::vector<Reader> file_readers() {
  around();
  return {
      {"scenario", read_scenario, kScenario},
      {"set", read_set, "forces.face_drag.K_F=0.45"},
      {"ruleset", read_ruleset_text, kRules},
      {"drawing", read_drawing, "name cross5\n.#.\n###\n.#.\n"},
      {"study", read_study, kStudy},
      {"study-record", read_study_record, plan_text(around().study->plan())},
      {"optimize", read_optimize, kOptimize},
      {"experiment", read_experiment, kExperiment},
      {"bodies", read_bodies, kBodies},
      {"bodies-table", read_falls, fall_rows()},
      {"flow", read_flow, kFlow},
      {"poses", read_poses, kPoses},
      {"trajectory-binary", read_binary, binary_trajectory()},
      {"trajectory-csv", read_csv, stored("run/trajectory.csv")},
      {"metrics", read_metrics, stored("run/metrics.csv")},
      {"events", read_events, stored("run/events.csv")},
      {"event-log", read_log, kLogColumns + "\n0.5,latch,0,1\n1.25,link,1,0\n9,unlink,0,1\n"},
      {"rates", read_rates, rate_rows()},
      {"checkpoint", read_checkpoint, checkpoint()},
      {"study-rows", read_rows,
       row_header() + with_checksum(row_line(around().row, around().study->plan().identity())) +
           "\n"},
      {"kept-rows", read_kept_rows,
       "lilytank rows 2 " + hex(7) + "\n" + with_checksum("0,1.5,0") + ";\n" +
           with_checksum("1,1.5,nan") + ";\n"},
      {"measured-world", read_measured, to_csv(MeasuredWorld{}, 7)},
      {"flow-truth", read_truth, kFlow},
      {"values", read_values, "1.5 cm\n"},
  };
}

}  // namespace lilytank::fuzz
