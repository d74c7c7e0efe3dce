// lilytank flow: the water's velocity from the tracks of balls.
#include <algorithm>
#include <iostream>

#include "cli/options.hpp"
#include "cli/point_bodies.hpp"
#include "cli/progress.hpp"
#include "cli/provenance.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/experiment.hpp"
#include "lilytank/flow_report.hpp"
#ifdef LILYTANK_HAS_RENDER
#include "lilytank/render.hpp"
#endif

namespace lilytank::cli {
namespace {

const std::vector<std::string>& estimator_words() {
  static const std::vector<std::string> words{"paper", "smooth", "both"};
  return words;
}

std::string estimator(const VerbOptions& options) {
  const std::string word = options.text("estimator", "both");
  for (const std::string& known : estimator_words()) {
    if (word == known) return word;
  }
  options.refuse("--estimator " + word + " is none of paper, smooth, both" +
                 did_you_mean(word, estimator_words()));
}

FlowOptions flow_options(const VerbOptions& options) {
  FlowOptions f;
  f.cells = static_cast<int>(options.whole("cells", f.cells, 4, 400));
  f.least_samples = static_cast<int>(options.whole("least", f.least_samples, 2, 1000000));
  f.significance = options.number("level", f.significance, 1e-6, 0.5);
  f.smoothing.window = options.number("window", f.smoothing.window, 1e-4, 100, "s");
  f.smoothing.degree = static_cast<int>(options.whole("degree", f.smoothing.degree, 2, 5));
  if (options.has("kalman")) {
    if (options.has("window") || options.has("degree")) {
      options.refuse("--kalman has neither --window nor --degree");
    }
    f.smoothing.method = SmoothingMethod::kalman;
  }
  return f;
}

Experiment balls_of(const VerbOptions& options) {
  refuse_point_bodies(options.positional());
  return load_experiment(
      options.positional(), options.list("set"),
      [](const RecordingSource& source) { return source.options.body == BodyKind::ball; });
}

// The drag coefficient from --drag, or as the experiment's files set it.
BallPhysics physics(const VerbOptions& options, const Experiment& experiment) {
  BallPhysics ball = ball_physics(experiment.base);
  ball.drag_coefficient = options.number("drag", ball.drag_coefficient, 1e-3, 100);
  return ball;
}

void add_flow_options(VerbOptions& options) {
  const auto text = [] { return cxxopts::value<std::string>(); };
  options.add()("estimator", "paper (Eq. 3), smooth (momentum balance), or both", text(), "WORD")(
      "truth", "a grid of known flow: prints and draws the errors", text(), "GRID.csv")(
      "bias", "measure the errors on synthetic recordings like these")(
      "out", "directory of the results (default: out/flow-<name>)", text(), "DIR")(
      "set", "a value over the experiment's, as ball.mass='13 g'",
      cxxopts::value<std::vector<std::string>>(), "PATH=VALUE")(
      "drag", "drag coefficient C of a ball (0.47, or forces.ball_drag.C if it is set)", text(),
      "C")("cells", "of the grid, a side (50)", text(), "N")(
      "least", "frames in a cell below which it is filled from its neighbours (20)", text(), "N")(
      "window", "of Eq. 3's smoothing polynomials (0.3 s)", text(), "TIME")(
      "degree", "of these polynomials (3)", text(), "N")(
      "kalman", "smooth for Eq. 3 by a Kalman smoother instead")(
      "level", "significance of the tests of normality (0.05)", text(), "P")(
      "seed", "of --bias (1)", text(), "N")("force", "replace other results in the directory")(
      "quiet", "no progress");
}

std::uint64_t seed_of(const VerbOptions& options) {
  return static_cast<std::uint64_t>(options.whole("seed", 1, 0, INT64_MAX));
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

void measure_bias(const VerbOptions& options, const std::vector<Recording>& recordings,
                  FlowReport& report) {
  const FlowEstimate* smooth = nullptr;
  for (const FlowEstimate& e : report.estimates) {
    if (e.noise) smooth = &e;
  }
  if (smooth == nullptr) options.refuse("--bias needs --estimator smooth or both");
  Progress progress(options.has("quiet"));
  JobControl control;
  progress.watch(control);
  report.bias = measure_flow_bias(recordings, *smooth, report.ball, report.options,
                                  seed_of(options), control);
  progress.clear();
}

std::vector<std::string> input_files(const VerbOptions& options, const Experiment& experiment) {
  std::vector<std::string> files = options.positional();
  for (const RecordingSource& source : experiment.sources) {
    if (source.options.body == BodyKind::ball) files.push_back(source.file);
  }
  return files;
}

/// Tables and, where they can be drawn, maps.
void write_report(const FlowReport& report, const ReportDocument& document,
                  const std::string& dir) {
  write_flow(report, document, dir);
#ifdef LILYTANK_HAS_RENDER
  draw_flow(report, document, dir);
#else
  std::cerr << "no maps: this program was built without the renderer (Cairo was not found)\n";
#endif
}

}  // namespace

int flow_verb(const Arguments& arguments) {
  VerbOptions options(
      "flow", "EXPERIMENT.toml...",
      "Estimates the water's velocity from the tracks of an experiment's balls: mean and "
      "standard deviation on a grid, with errors. Writes text, tables and maps.");
  add_flow_options(options);
  if (!options.parse(arguments)) return Exit::done;
  if (options.positional().empty()) {
    options.refuse("of what? write lilytank flow EXPERIMENT.toml");
  }
  FlowReport report;
  report.options = flow_options(options);
  const std::string word = estimator(options);
  if (options.has("bias") && word == "paper") {
    options.refuse("--bias needs --estimator smooth or both");
  }
  const Experiment experiment = balls_of(options);
  report.name = experiment.name;
  report.ball = physics(options, experiment);
  report.truth_file = options.text("truth");
  if (options.has("truth")) {
    report.truth = read_flow_truth(report.truth_file, report.options.cells);
  }
  const std::string dir = options.text("out", "out/flow-" + report.name);
  const ReportProvenance origin =
      provenance("flow", arguments, seed_of(options), input_files(options, experiment));
  const DirectoryJob job{"flow", identity_of(origin), flow_files()};
  const bool force = options.has("force");
  check_directory(dir, force, job);
  estimate(word, experiment.recordings, report);
  const auto lock = claim_directory(dir, force, job);
  const auto write = [&] {
    ReportDocument document = flow_report(report);
    document.provenance = origin;
    write_report(report, document, dir);
    return document;
  };
  ReportDocument document = write();
  if (options.has("bias")) {
    // Takes minutes: the estimates are stored before.
    measure_bias(options, experiment.recordings, report);
    document = write();
  }
  std::cout << report_text(document) << std::flush;
  std::cerr << "results in " << dir << "\n";
  return Exit::done;
}

}  // namespace lilytank::cli
