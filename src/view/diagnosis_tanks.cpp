// Tanks of a page from a diagnosis: a recording beside simulations before and after.
#include <algorithm>
#include <filesystem>
#include <map>

#include "io/atomic_file.hpp"
#include "io/json.hpp"
#include "io/scenario_values.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/view.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

const std::string kStep = "run.dt='5 ms'";  // that of the diagnosis
constexpr std::uint64_t kSeed = 1;

struct StoredDiagnosis {
  std::string name, verdict;
  std::vector<std::string> effects;
  std::vector<std::string> sets;  ///< the baseline as --set values
};

StoredDiagnosis read_diagnosis(const std::string& dir) {
  const std::string file = (fs::path(dir) / "diagnosis.json").string();
  const std::string flow = (fs::path(dir) / "flow.csv").string();
  StoredDiagnosis out;
  try {
    const Json all = json_of(read_whole(file));
    out.name = all.at("name").get<std::string>();
    out.verdict = all.at("verdict").get<std::string>();
    for (const Json& f : all.at("findings")) {
      out.effects.push_back(f.at("effect").get<std::string>());
    }
    for (const Json& p : all.at("parameters")) {
      out.sets.push_back(p.at("path").get<std::string>() + "=" +
                         shortest(p.at("alone").get<double>()));
    }
  } catch (const Json::exception&) {
    throw InputError({file}, "this is no result of lilytank diagnose, or it is damaged");
  }
  if (out.sets.empty()) {
    throw InputError({file}, "the verdict is " + out.verdict +
                                 ": no model was fitted, so there is no simulation to show");
  }
  if (exists(flow)) out.sets.push_back("flow.file=" + toml_quoted(flow));
  return out;
}

/// A recording as poses: one body for each identity, `seen` where its position is known.
ViewTank tank_of(const Recording& recording, const Scenario& scenario) {
  ViewTank tank;
  tank.run.scenario = scenario, tank.headings = recording.has_heading();
  std::map<std::int64_t, std::size_t> bodies;
  for (const Track& track : recording.tracks) {
    if (bodies.emplace(track.id, bodies.size()).second) tank.ids.push_back(track.id);
  }
  Trajectory& out = tank.run.trajectory;
  const std::size_t n = tank.ids.size(), all = n * static_cast<std::size_t>(recording.frames);
  out.bodies = static_cast<int>(n);
  out.modules = recording.body == BodyKind::lily ? out.bodies : 0;
  for (int f = 0; f < recording.frames; ++f) out.time.push_back(recording.time(f));
  out.x.assign(all, 0), out.y.assign(all, 0), out.theta.assign(all, 0);
  tank.seen.assign(all, 0);
  for (const Track& track : recording.tracks) {
    const std::size_t body = bodies.at(track.id);
    for (std::size_t k = 0; k < track.x.size(); ++k) {
      if (std::isnan(track.x[k])) continue;
      const std::size_t i = (static_cast<std::size_t>(track.first) + k) * n + body;
      out.x[i] = static_cast<float>(track.x[k]), out.y[i] = static_cast<float>(track.y[k]);
      if (tank.headings) out.theta[i] = static_cast<float>(track.theta[k]);
      tank.seen[i] = 1;
    }
  }
  return tank;
}

/// Simulates what a recording shows, from its poses where all bodies were seen at its begin.
ViewTank simulated(const Recording& recording, const Scenario& scenario) {
  RecordingShape shape = shape_of(recording, scenario.model.module.side);
  shape.missing = 0;
  const double start =
      shape.starts.empty() ? recording.start : recording.time(shape.starts.front().frame);
  const Emulator emulator(scenario.model, {}, {shape},
                          {.moment_matched = false, .position_noise = 0, .heading_noise = 0});
  auto made = emulator.record({}, kSeed);
  if (!made) throw InputError("the simulation of " + recording.name + " diverges");
  Recording& one = made->front();
  one.start = start;
  // Bodies of equal places at the start have equal names, if no track ends or begins later.
  if (one.tracks.size() == recording.tracks.size()) {
    for (std::size_t i = 0; i < one.tracks.size(); ++i) one.tracks[i].id = recording.tracks[i].id;
  }
  ViewTank tank = tank_of(one, scenario);
  tank.note = shape.starts.empty() ? "simulation, begins at random places"
                                   : "simulation, begins as the recording does";
  return tank;
}

const RecordingSource& chosen_source(const Experiment& experiment, const std::string& name) {
  const RecordingSource* chosen = nullptr;
  std::vector<std::string> lilies;
  for (const RecordingSource& source : experiment.sources) {
    if (source.options.body != BodyKind::lily) continue;
    lilies.push_back(source.file);
    if (name.empty() ? chosen == nullptr || (source.options.held_out && !chosen->options.held_out)
                     : source.file == name || fs::path(source.file).filename() == name) {
      chosen = &source;
    }
  }
  if (chosen != nullptr) return *chosen;
  if (lilies.empty()) throw InputError("the experiment " + experiment.name + " has no Lilies");
  throw InputError("'" + name + "' is no recording of Lilies of the experiment: " +
                   joined(lilies, ", ") + did_you_mean(name, lilies));
}

}  // namespace

ViewPage view_diagnosis(const std::string& dir, const std::string& experiment,
                        const std::string& recording, const JobControl& control) {
  const StoredDiagnosis stored = read_diagnosis(dir);
  std::vector<std::string> sets{kStep};
  sets.insert(sets.end(), stored.sets.begin(), stored.sets.end());
  const auto none = [](const RecordingSource&) { return false; };
  const Experiment before = load_experiment({experiment}, sets, none);
  if (before.name != stored.name) {
    throw InputError("'" + dir + "' holds the diagnosis of " + stored.name + ", not of " +
                     before.name);
  }
  const std::string file = chosen_source(before, recording).file;
  const Experiment with = load_experiment(
      {experiment}, {}, [&](const RecordingSource& source) { return source.file == file; });
  const Recording& recorded = with.recordings.front();
  if (recorded.tracks.empty()) throw InputError({file}, "no Lily is tracked in it");
  ViewPage page;
  page.title = "Diagnosis of " + stored.name;
  page.subtitle = "verdict: " + stored.verdict +
                  (stored.effects.empty() ? "" : ", " + joined(stored.effects, ", "));
  ViewTank& real = page.tanks.emplace_back(tank_of(recorded, before.base));
  real.name = "recorded", real.note = recorded.name;
  control.check_stop();
  page.tanks.push_back(simulated(recorded, before.base));
  page.tanks.back().name = "baseline";
  const std::string overlay = (fs::path(dir) / "missing.toml").string();
  if (!exists(overlay)) return page;
  control.check_stop();
  page.tanks.push_back(simulated(recorded, load_experiment({experiment, overlay}, {}, none).base));
  page.tanks.back().name = "with " + joined(stored.effects, ", ");
  return page;
}

}  // namespace lilytank
