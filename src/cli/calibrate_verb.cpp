// lilytank calibrate: the model's parameters from recordings.
#include <filesystem>
#include <iostream>

#include "cli/options.hpp"
#include "cli/point_bodies.hpp"
#include "cli/progress.hpp"
#include "cli/provenance.hpp"
#include "io/atomic_file.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/calibration.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/recovery.hpp"
#ifdef LILYTANK_HAS_RENDER
#include "lilytank/render.hpp"
#endif
#include "text/number.hpp"

namespace lilytank::cli {
namespace {

void add_calibrate_options(VerbOptions& options) {
  const auto text = [] { return cxxopts::value<std::string>(); };
  const auto list = [] { return cxxopts::value<std::vector<std::string>>(); };
  options.add()("objective", "summary (default), msd-weighted, or msd (the paper's Eq. 9)", text(),
                "WORD")("flow", "smooth (default) or paper: from the balls; or scenario", text(),
                        "WORD")("balls", "calibrate the balls' parameters instead of the Lilies'")(
      "vary", "another parameter, or another range of one: forces.body_force.force_x=-0.01..0.01",
      list(),
      "PATH=LOW..HIGH")("hold-out", "keep the last N recordings for testing (0)", text(), "N")(
      "search", "cma-es, paper-lilies, paper-balls: how the region is found", text(), "WORD")(
      "budget", "evaluations of the search (1500; of a swarm as many as the paper)", text(), "N")(
      "replicates", "experiments simulated for the intervals (200)", text(), "N")(
      "simulations", "of the first response surfaces (120); the last one has twice as many", text(),
      "N")("comparisons", "experiments simulated for Eq. 9 before and after (24)", text(), "N")(
      "flow-draws", "extractions simulated for the flow's error (24; 0: the flow is exact)", text(),
      "N")("start", "overlay with the values at which the search starts, as calibrated.toml",
           text(),
           "FILE")("set", "a value over the experiment's, as run.dt='5 ms'", list(), "PATH=VALUE")(
      "recover",
      "calibrate N synthetic experiments in this scenario and see whether the intervals "
      "hold the truth",
      text(), "N")("duration", "of a recording, with --recover ('10 min')", text(), "TIME")(
      "recordings", "of an experiment, with --recover (3)", text(), "N")(
      "out", "directory of the results (default: out/calibrate-<name>)", text(), "DIR")(
      "seed", "of everything that is drawn (1)", text(), "N")(
      "threads", "simulations at a time (default: one a core)", text(), "N")(
      "force", "replace another calibration's files")("quiet", "no progress");
}

// "PATH=LOW..HIGH": takes the place of the parameter of that path, or comes after the others.
void vary(const VerbOptions& options, const std::string& assignment,
          std::vector<FitParameter>& parameters) {
  const auto equals = assignment.find('='), dots = assignment.find("..");
  const auto malformed = [&]() {
    options.refuse("--vary " + assignment +
                   " is not of the form PATH=LOW..HIGH, as in --vary "
                   "forces.face_drag.K_F=0.1..1");
  };
  if (equals == std::string::npos || dots == std::string::npos || dots < equals) malformed();
  const ModelParameter of = model_parameter(assignment.substr(0, equals));
  const auto low = parse_number(assignment.substr(equals + 1, dots - equals - 1));
  const auto high = parse_number(assignment.substr(dots + 2));
  if (!low || !high) malformed();
  if (!(*low < *high) || *low < of.low || *high > of.high) {
    options.refuse("--vary " + assignment + ": the range must rise and lie within " +
                   shortest(of.low) + " .. " + shortest(of.high));
  }
  // A range over a factor of three or more is looked through by factors.
  const bool logarithmic = *low > 0 && *high >= 3 * *low;
  const FitParameter wanted{of.path, of.unit, *low, *high, logarithmic, false};
  for (FitParameter& p : parameters) {
    if (p.path == of.path) {
      p = wanted;
      return;
    }
  }
  parameters.push_back(wanted);
}

CalibrationOptions calibration_options(const VerbOptions& options) {
  CalibrationOptions c;
  c.body = options.has("balls") ? BodyKind::ball : BodyKind::lily;
  c.objective = objective_named(options.text("objective", "summary"));
  c.flow = flow_named(options.text("flow", "smooth"));
  c.parameters = standard_parameters(c.body);
  for (const std::string& one : options.list("vary")) vary(options, one, c.parameters);
  c.hold_out = static_cast<int>(options.whole("hold-out", 0, 0, 1000));
  c.search_name = options.text(
      "search", c.objective == CalibrationObjective::msd ? "paper-lilies" : c.search_name);
  std::vector<std::string> searches = swarm_presets();
  searches.push_back("cma-es");
  if (std::find(searches.begin(), searches.end(), c.search_name) == searches.end()) {
    options.refuse("--search " + c.search_name + " is not known" +
                   did_you_mean(c.search_name, searches));
  }
  c.search_budget = options.whole("budget", c.search_budget, 20, 100000000);
  if (c.search_name != "cma-es" && options.has("budget")) {
    const SwarmOptions swarm = swarm_preset(c.search_name);
    c.search_iterations = static_cast<int>(
        std::max<std::int64_t>(1, c.search_budget / (swarm.particles * swarm.evaluations)));
  }
  c.replicates = static_cast<int>(options.whole("replicates", c.replicates, 20, 100000));
  c.round = static_cast<int>(options.whole("simulations", c.round, 40, 100000));
  c.last_round = 2 * c.round;
  c.comparisons = static_cast<int>(options.whole("comparisons", c.comparisons, 2, 100000));
  c.flow_draws = static_cast<int>(options.whole("flow-draws", c.flow_draws, 0, 10000));
  c.seed = static_cast<std::uint64_t>(options.whole("seed", 1, 0, INT64_MAX));
  c.threads = static_cast<int>(options.whole("threads", 0, 0, 4096));
  c.force = options.has("force");
  return c;
}

// The parameters' values where the last file overrides the others. Only these: a file of another
// experiment has another tank and other modules.
std::vector<double> start_values(const std::vector<std::string>& files,
                                 const std::vector<std::string>& sets,
                                 const std::vector<FitParameter>& parameters) {
  const Model model = load_experiment(files, sets).base.model;
  std::vector<double> values;
  for (const FitParameter& p : parameters) values.push_back(parameter_value(model, p.path));
  return values;
}

// --recover: no recordings are read, they are simulated.
int recover_verb(const VerbOptions& options, const Arguments& arguments, CalibrationOptions job) {
  options.refuse_given({"start", "comparisons", "balls"}, "has no effect with --recover");
  if (job.flow == CalibrationFlow::paper) {
    options.refuse("--flow " + options.text("flow") +
                   " does not go with --recover: smooth or scenario");
  }
  const Scenario scenario = load_scenario(options.positional(), options.list("set"));
  RecoveryOptions r;
  r.experiments = static_cast<int>(options.whole("recover", 10, 1, 100000));
  r.recordings = static_cast<int>(options.whole("recordings", r.recordings, 1, 100));
  r.seconds = options.number("duration", r.seconds, 10, 1e6, "s");
  if (options.has("objective")) r.objectives = {job.objective};
  if (options.has("flow") && job.flow == CalibrationFlow::smooth) r.balls = 24;
  const std::string title = scenario.title.empty() ? "scenario" : scenario.title;
  job.out = options.text("out", (std::filesystem::path("out") / ("recover-" + title)).string());
  Progress progress(options.has("quiet"));
  progress.watch(job);
  r.calibration = job;
  r.done = [&](const std::vector<RecoveryRow>& rows) {
    const std::filesystem::path out = job.out;
    write_atomically((out / "recovery.csv").string(), recovery_csv(rows));
    write_atomically((out / "recovery.txt").string(), recovery_text(rows));
  };
  const ReportProvenance origin =
      provenance("calibrate", arguments, job.seed, options.positional());
  const auto lock = claim_directory(
      job.out, job.force, {"recovery", identity_of(origin), {"recovery.csv", "recovery.txt"}});
  const std::vector<RecoveryRow> rows = recover(scenario, r);
  progress.clear();
  std::cout << recovery_text(rows) << std::flush;
  std::cerr << "results in " << job.out << "\n";
  return Exit::done;
}

}  // namespace

int calibrate_verb(const Arguments& arguments) {
  VerbOptions options("calibrate", "EXPERIMENT.toml...",
                      "Estimates the model's parameters from an experiment's recordings, with "
                      "intervals, parameters that the data do not constrain, and the fit of the "
                      "calibrated model.");
  add_calibrate_options(options);
  if (!options.parse(arguments)) return Exit::done;
  if (options.positional().empty()) {
    options.refuse("of what? write lilytank calibrate EXPERIMENT.toml");
  }
  if (!options.has("recover"))
    options.refuse_given({"duration", "recordings"}, "goes with --recover");
  refuse_point_bodies(options.positional());
  CalibrationOptions job = calibration_options(options);
  if (options.has("recover")) return recover_verb(options, arguments, std::move(job));
  std::vector<std::string> files = options.positional();
  const Experiment experiment = load_experiment(files, options.list("set"));
  if (options.has("start")) {
    files.push_back(options.text("start"));
    job.start = start_values(files, options.list("set"), job.parameters);
  }
  job.out = options.text(
      "out", (std::filesystem::path("out") / ("calibrate-" + experiment.name)).string());
  if (job.out.empty()) options.refuse("--out is empty");
  Progress progress(options.has("quiet"));
  progress.watch(job);
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  job.lock = &lock;
  const CalibrationResult found = calibrate(experiment, job);
  progress.clear();
  ReportDocument report = calibration_report(found);
  for (const RecordingSource& source : experiment.sources) files.push_back(source.file);
  report.provenance = provenance("calibrate", arguments, job.seed, files);
  write_calibration(found, report, job.out);
#ifdef LILYTANK_HAS_RENDER
  draw_calibration(found, report, job.out);
#else
  std::cerr << "no plots: this program was built without the renderer (Cairo was not found)\n";
#endif
  std::cout << report_text(report) << std::flush;
  std::cerr << "results in " << job.out << "\n";
  return Exit::done;
}

}  // namespace lilytank::cli
