// lilytank flow: the water's velocity from the tracks of balls.
#include <iostream>

#include "cli/inputs.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/experiment.hpp"
#include "lilytank/flow_report.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

struct FlowJob {
  FlowOptions flow;
  std::string estimator = "both", truth;
  std::vector<std::string> sets;
  double drag = 0;  // coefficient; 0: that of the experiment
  std::uint64_t seed = 1;
  FigureStyle style;
  bool bias = false, force = false, quiet = false;
};

void add_flow_options(VerbOptions& options, FlowJob& job) {
  FlowOptions& f = job.flow;
  options.add({"estimator", "paper (Eq. 3), smooth (momentum balance), or both", "WORD"},
              &job.estimator, {"paper", "smooth", "both"});
  options.add({"truth", "a grid of known flow: prints and draws the errors", "GRID.csv"},
              &job.truth);
  options.add({"bias", "measure the errors on synthetic recordings like these"}, &job.bias);
  options.add({"out", "directory of the results (default: out/flow-<name>)", "DIR"});
  options.add({"set", "a value over the experiment's, as ball.mass='13 g'", "PATH=VALUE"},
              &job.sets);
  options.add(
      {"drag", "drag coefficient C of a ball (0.47, or forces.ball_drag.C if it is set)", "C"},
      &job.drag, 1e-3, 100);
  options.add({"cells", "of the grid, a side (50)", "N"}, &f.cells, 4, 400);
  options.add({"least", "frames in a cell below which it is filled from its neighbours (20)", "N"},
              &f.least_samples, 2, 1000000);
  options.add({"window", "of Eq. 3's smoothing polynomials (0.3 s)", "TIME"}, &f.smoothing.window,
              1e-4, 100, "s");
  options.add({"degree", "of these polynomials (3)", "N"}, &f.smoothing.degree, 2, 5);
  options.add({"kalman", "smooth for Eq. 3 by a Kalman smoother instead"});
  options.add({"level", "significance of the tests of normality (0.05)", "P"}, &f.significance,
              1e-6, 0.5);
  options.add({"seed", "of --bias (1)", "N"}, &job.seed, 0, INT64_MAX);
  add_figure_options(options, job.style);
  options.add({"dry-run", "read everything, write nothing"});
  options.add({"force", "replace other results in the directory"}, &job.force);
  options.add({"quiet", "no progress"}, &job.quiet);
}

void check_flow_options(const VerbOptions& options, FlowJob& job) {
  if (options.has("kalman")) {
    if (options.has("window") || options.has("degree")) {
      options.refuse("--kalman has neither --window nor --degree");
    }
    job.flow.smoothing.method = SmoothingMethod::kalman;
  }
  if (job.bias && job.estimator == "paper") {
    options.refuse("--bias needs --estimator smooth or both");
  }
}

// `word`: paper, smooth or both.
void estimate(const std::string& word, const std::vector<Recording>& recordings,
              FlowReport& report) {
  if (word != "smooth") {
    report.estimates.push_back(estimate_paper(recordings, report.ball, report.options));
  }
  if (word != "paper") {
    report.estimates.push_back(estimate_smooth(recordings, report.ball, report.options));
  }
}

// Of the smooth estimate, which is the last one.
void measure_bias(const FlowJob& job, const std::vector<Recording>& recordings, FlowReport& report,
                  const Host& host) {
  Progress progress(job.quiet, host);
  JobControl control;
  progress.watch(control);
  report.bias = measure_flow_bias(recordings, report.estimates.back(), report.ball, report.options,
                                  job.seed, control);
  progress.clear();
}

int dry_run(const FlowJob& job, const Experiment& experiment, const std::string& dir) {
  int recordings = 0;
  double seconds = 0;
  for (const Recording& r : experiment.recordings) {
    if (r.body != BodyKind::ball) continue;
    recordings += 1, seconds += r.frames / r.rate;
  }
  if (recordings == 0) throw InputError(experiment.name + " has no recording of body = \"ball\"");
  std::cout << "would estimate the flow of " << experiment.name << " from "
            << counted(recordings, "recording") << " of balls (" << significant(seconds, 4)
            << " s) on " << job.flow.cells << " x " << job.flow.cells << " cells, estimator "
            << job.estimator << (job.bias ? ", with errors on synthetic recordings" : "") << "; in "
            << dir << "\n";
  return Exit::done;
}

std::vector<std::string> input_files(const VerbOptions& options, const Experiment& experiment) {
  std::vector<std::string> files = options.positional();
  for (const RecordingSource& source : experiment.sources) files.push_back(source.file);
  return files;
}

}  // namespace

int flow_verb(const Arguments& arguments, const Host& host) {
  VerbOptions options(
      "flow", "EXPERIMENT.toml...",
      "Estimates the water's velocity from the tracks of an experiment's balls: mean and "
      "standard deviation on a grid, with errors. Writes text, tables and maps.");
  FlowJob job;
  add_flow_options(options, job);
  if (!options.parse(arguments, "of what? write lilytank flow EXPERIMENT.toml")) return Exit::done;
  check_flow_options(options, job);
  refuse_point_bodies(options.positional());
  // Balls, from which the flow is estimated, and Lilies: where they went it must be known.
  const Experiment experiment = load_experiment(options.positional(), job.sets);
  FlowReport report;
  report.options = job.flow;
  report.name = experiment.name;
  report.ball = ball_physics(experiment.base);
  if (job.drag > 0) report.ball.drag_coefficient = job.drag;
  report.truth_file = job.truth;
  if (options.has("truth")) report.truth = read_flow_truth(job.truth, job.flow.cells);
  const std::string dir = options.out("out/flow-" + report.name);
  const ReportProvenance origin =
      provenance("flow", arguments, job.seed, input_files(options, experiment));
  const DirectoryJob owner{"flow", identity_of(origin), flow_files()};
  check_directory(dir, job.force, owner);
  if (options.has("dry-run")) return dry_run(job, experiment, dir);
  estimate(job.estimator, experiment.recordings, report);
  report.coverage =
      coverage_of(&report.estimates.back(), experiment.recordings, experiment.recordings);
  const auto lock = claim_directory(dir, job.force, owner);
  ReportDocument document;
  const auto write = [&] {
    document = flow_report(report);
    document.provenance = origin;
    write_flow(report, document, dir);
    if constexpr (kDraws) draw_flow(report, document, dir, job.style);
    if constexpr (!kDraws) say_undrawn("maps");
  };
  write();
  if (job.bias) {
    // Takes minutes: the estimates are stored before.
    measure_bias(job, experiment.recordings, report, host);
    write();
  }
  return print_results(document, dir, host);
}

}  // namespace lilytank::cli
