// lilytank diagnose: what physics a model leaves out.
#include <algorithm>
#include <iostream>

#include "cli/inputs.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "lilytank/bodies.hpp"
#include "lilytank/diagnosis.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

struct DiagnoseJob {
  DiagnosisOptions diagnosis;
  std::vector<std::string> sets;
  std::string tank, tank_results;
  FigureStyle style;
  bool quiet = false;
};

void add_diagnose_options(VerbOptions& options, DiagnoseJob& job) {
  DiagnosisOptions& d = job.diagnosis;
  options.add({"out", "directory of the results (default: out/diagnose-<name>)", "DIR"});
  options.add({"seed", "of everything that is drawn (1)", "N"}, &d.seed, 0, INT64_MAX);
  options.add(
      {"budget", "minutes that it may take on two cores (10); at least 3 for a tank", "MINUTES"},
      &d.minutes, 1, 1e4);
  options.add({"hold-out", "recordings kept for showing, if none is marked held_out (1)", "N"},
              &d.hold_out, 0, 1000);
  options.add(
      {"tank",
       "an experiment in the same tank that was diagnosed: its null experiments serve again",
       "EXPERIMENT.toml"},
      &job.tank);
  options.add(
      {"tank-results", "directory of its results (default: out/diagnose-<its name>)", "DIR"},
      &job.tank_results);
  options.add({"set", "a value over the experiment's, as run.dt='5 ms'", "PATH=VALUE"}, &job.sets);
  options.add({"threads", "simulations at a time (default: one a core)", "N"}, &d.threads, 0, 4096);
  options.add(
      {"uncertified", "diagnose insufficient recordings, too: error rates are then unknown"},
      &d.uncertified);
  add_figure_options(options, job.style);
  options.add({"dry-run", "read everything, write nothing"});
  options.add({"force", "replace another diagnosis's files"}, &d.force);
  options.add({"quiet", "no progress"}, &job.quiet);
}

DiagnosedTank diagnosed_tank(const DiagnoseJob& job, const std::vector<std::string>& sets) {
  DiagnosedTank tank{load_experiment({job.tank}, sets), job.tank_results};
  if (tank.directory.empty()) tank.directory = "out/diagnose-" + tank.experiment.name;
  return tank;
}

void add_sources(const Experiment& experiment, std::vector<std::string>& inputs) {
  for (const RecordingSource& source : experiment.sources) {
    inputs.push_back(source.file);
    if (!source.options.events.empty()) inputs.push_back(source.options.events);
  }
}

int dry_run(const std::string& what, double minutes, const DiagnosisOptions& job) {
  check_directory_of("diagnosis", job.out, job.force);
  std::cout << "would diagnose " << what << ": about " << significant(minutes, 3)
            << " min on two cores; in " << job.out << "\n";
  return Exit::done;
}

int dry_run(const Experiment& experiment, const DiagnosisOptions& job) {
  std::int64_t recordings = 0, held_out = 0;
  for (const Recording& r : experiment.recordings) {
    if (r.body != BodyKind::lily) continue;
    recordings += 1, held_out += r.held_out ? 1 : 0;
  }
  if (held_out == 0) held_out = std::min<std::int64_t>(job.hold_out, recordings);
  return dry_run(experiment.name + ": " + counted(recordings, "recording") + " of Lilies, " +
                     std::to_string(held_out) + " held out",
                 std::max(job.minutes, kLeastTankMinutes), job);
}

}  // namespace

int diagnose_verb(const Arguments& arguments, const Host& host) {
  VerbOptions options("diagnose", "EXPERIMENT.toml...",
                      "Says where an experiment's recordings and the model differ, which effect is "
                      "missing, how large it is, and how much of the difference it removes.");
  DiagnoseJob job;
  DiagnosisOptions& d = job.diagnosis;
  add_diagnose_options(options, job);
  if (!options.parse(arguments, "of what? write lilytank diagnose EXPERIMENT.toml")) {
    return Exit::done;
  }
  if (!options.has("tank")) options.refuse_given({"tank-results"}, "goes with --tank");
  Progress progress(job.quiet, host);
  progress.watch(d);
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  d.lock = &lock;
  Diagnosis found;
  std::vector<std::string> inputs = options.positional();
  if (inputs.size() == 1 && is_body_experiment(inputs[0])) {
    options.refuse_given({"set", "hold-out", "uncertified", "tank"},
                         "has no effect on an experiment of point bodies");
    const BodyExperiment experiment = load_body_experiment(inputs[0]);
    d.out = options.out("out/diagnose-" + experiment.name);
    inputs.insert(inputs.end(), experiment.files.begin(), experiment.files.end());
    if (options.has("dry-run")) {
      const auto runs = std::ssize(experiment.runs);
      return dry_run(experiment.name + ": " + counted(runs, "run") + " of point bodies", d.minutes,
                     d);
    }
    found = diagnose_bodies(experiment, d);
  } else {
    refuse_point_bodies(inputs);
    // Recordings have no steps: those of the simulations must be short enough not to show.
    std::vector<std::string> sets{"run.dt='5 ms'"};
    sets.insert(sets.end(), job.sets.begin(), job.sets.end());
    const Experiment experiment = load_experiment(inputs, sets);
    d.out = options.out("out/diagnose-" + experiment.name);
    add_sources(experiment, inputs);
    if (options.has("dry-run")) return dry_run(experiment, d);
    if (options.has("tank")) {
      const DiagnosedTank tank = diagnosed_tank(job, sets);
      inputs.push_back(job.tank);
      add_sources(tank.experiment, inputs);
      found = diagnose(experiment, tank, d);
    } else {
      found = diagnose(experiment, d);
    }
  }
  progress.clear();
  ReportDocument report = diagnosis_report(found);
  report.provenance = provenance("diagnose", arguments, d.seed, inputs);
  write_diagnosis(found, report, d.out);
  if constexpr (kDraws) draw_diagnosis(found, report, d.out, job.style);
  if constexpr (!kDraws) say_undrawn("report.html");
  return print_results(report, d.out, host);
}

}  // namespace lilytank::cli
