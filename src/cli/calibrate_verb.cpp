// lilytank calibrate: the model's parameters from recordings.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "cli/inputs.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "io/atomic_file.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/calibration.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/recovery.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

struct CalibrateJob {
  CalibrationOptions calibration;
  RecoveryOptions recovery;
  std::string objective, flow = "smooth";
  std::vector<std::string> vary, sets;
  FigureStyle style;
  bool quiet = false;
};

void add_calibrate_options(VerbOptions& options, CalibrateJob& job) {
  CalibrationOptions& c = job.calibration;
  RecoveryOptions& r = job.recovery;
  options.add({"objective",
               "prediction (default where it can be used), summary, msd-weighted, or msd (the "
               "paper's Eq. 9)",
               "WORD"},
              &job.objective);
  options.add({"flow", "smooth (default) or paper: from the balls; or scenario", "WORD"},
              &job.flow);
  options.add({"balls", "calibrate the balls' parameters instead of the Lilies'"});
  options.add(
      {"vary", "another parameter, or another range of one: forces.body_force.force_x=-0.01..0.01",
       "PATH=LOW..HIGH"},
      &job.vary);
  options.add({"hold-out", "keep the last N recordings for testing (0)", "N"}, &c.hold_out, 0,
              1000);
  options.add(
      {"search",
       "how the region is found: none (for prediction), cma-es, paper-lilies or paper-balls",
       "WORD"});
  options.add({"evaluations", "of a search (1500; of a swarm as many as the paper)", "N"},
              &c.search_budget, 20, 100000000);
  options.add(
      {"replicates", "experiments simulated for the intervals (200; for prediction 100)", "N"},
      &c.replicates, 20, 100000);
  options.add(
      {"simulations",
       "of the first response surfaces (120; for prediction 60); the last one has twice as many",
       "N"},
      &c.round, 40, 100000);
  options.add({"comparisons", "experiments simulated for Eq. 9 before and after (24)", "N"},
              &c.comparisons, 2, 100000);
  options.add(
      {"flow-draws",
       "extractions simulated for the flow's error (24; for prediction 12; 0: the flow is exact)",
       "N"},
      &c.flow_draws, 0, 10000);
  options.add(
      {"start", "overlay with the values at which the search starts, as calibrated.toml", "FILE"});
  options.add({"set", "a value over the experiment's, as run.dt='5 ms'", "PATH=VALUE"}, &job.sets);
  options.add({"recover",
               "calibrate N synthetic experiments in this scenario and see whether the intervals "
               "hold the truth",
               "N"},
              &r.experiments, 1, 100000);
  options.add({"duration", "of a recording, with --recover ('10 min')", "TIME"}, &r.seconds, 10,
              1e6, "s");
  options.add({"recordings", "of an experiment, with --recover (3)", "N"}, &r.recordings, 1, 100);
  options.add({"out", "directory of the results (default: out/calibrate-<name>)", "DIR"});
  options.add({"seed", "of everything that is drawn (1)", "N"}, &c.seed, 0, INT64_MAX);
  options.add({"threads", "simulations at a time (default: one a core)", "N"}, &c.threads, 0, 4096);
  options.add({"truth", "overlay with the values in synthetic recordings, for figures", "FILE"});
  add_figure_options(options, job.style);
  options.add({"dry-run", "check everything, say how long it would take, write nothing"});
  options.add({"force", "replace another calibration's files"}, &c.force);
  options.add({"quiet", "no progress"}, &job.quiet);
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

// What the words and the parameters to vary come to.
void complete(const VerbOptions& options, CalibrateJob& job) {
  CalibrationOptions& c = job.calibration;
  c.body = options.has("balls") ? BodyKind::ball : BodyKind::lily;
  if (!job.objective.empty()) c.objective = objective_named(job.objective);
  c.flow = flow_named(job.flow);
  c.parameters = standard_parameters(c.body);
  for (const std::string& one : job.vary) vary(options, one, c.parameters);
  if (options.has("evaluations")) c.search_name = "cma-es";
  if (c.objective == CalibrationObjective::msd) c.search_name = "paper-lilies";
  c.search_name = options.text("search", c.search_name);
  const std::vector<std::string> swarms = swarm_presets();
  std::vector<std::string> searches = swarms;
  searches.insert(searches.end(), {"cma-es", "none"});
  if (!c.search_name.empty() && std::ranges::find(searches, c.search_name) == searches.end()) {
    options.refuse("--search " + c.search_name + " is not known" +
                   did_you_mean(c.search_name, searches));
  }
  if (std::ranges::find(swarms, c.search_name) != swarms.end() && options.has("evaluations")) {
    const SwarmOptions swarm = swarm_preset(c.search_name);
    c.search_iterations = static_cast<int>(
        std::max<std::int64_t>(1, c.search_budget / (swarm.particles * swarm.evaluations)));
  }
}

// The parameters' values where `last` overrides the other files. Only these: a file of another
// experiment has another tank and other modules.
std::vector<double> values_with(std::vector<std::string> files, const std::string& last,
                                const std::vector<std::string>& sets,
                                const std::vector<FitParameter>& parameters) {
  files.push_back(last);
  const Model model = load_experiment(files, sets).base.model;
  std::vector<double> values;
  for (const FitParameter& p : parameters) values.push_back(parameter_value(model, p.path));
  return values;
}

// "2 recordings of 15 bodies; 24 extractions of the flow and about 640 simulated experiments: 33
// min of processor time"
std::string plan_line(const CalibrationPlan& plan) {
  std::string out = counted(plan.recordings, "recording") + " of up to " +
                    std::to_string(plan.bodies) + (plan.bodies == 1 ? " body; " : " bodies; ");
  if (plan.extractions > 0) {
    out += counted(plan.extractions, "extraction") + " of the flow (" +
           significant(plan.extraction_time, 2) + " s each) and ";
  }
  return out + "about " + significant(plan.experiments, 2) + " simulated experiments (" +
         significant(plan.experiment_time, 2) + " s each): about " +
         duration_text(plan.processor_time()) + " of processor time";
}

void print_shortfalls(const Coverage& coverage) {
  for (const Shortfall& s : coverage.flow) {
    std::cerr << "warning: " << s.what << ": record " << to_record({s}) << "\n";
  }
}

// --recover: no recordings are read, they are simulated.
int recover_verb(const VerbOptions& options, const Arguments& arguments, CalibrateJob& job,
                 Progress& progress) {
  CalibrationOptions& c = job.calibration;
  RecoveryOptions& r = job.recovery;
  options.refuse_given({"start", "truth", "comparisons", "balls", "dry-run"},
                       "has no effect with --recover");
  if (c.flow == CalibrationFlow::paper) {
    options.refuse("--flow " + job.flow + " does not go with --recover: smooth or scenario");
  }
  const Scenario scenario = load_scenario(options.positional(), job.sets);
  if (options.has("objective")) {
    r.objectives = {c.objective};
  } else {
    r.objectives.front() = default_objective({}, BodyKind::lily, c.parameters);
  }
  if (options.has("flow") && c.flow == CalibrationFlow::smooth) r.balls = 24;
  const std::string title = scenario.title.empty() ? "scenario" : scenario.title;
  c.out = options.out("out/recover-" + title);
  r.calibration = c;
  r.done = [&](const std::vector<RecoveryRow>& rows) {
    const std::filesystem::path out = c.out;
    write_atomically((out / "recovery.csv").string(), recovery_csv(rows));
    write_atomically((out / "recovery.txt").string(), recovery_text(rows));
  };
  const ReportProvenance origin = provenance("calibrate", arguments, c.seed, options.positional());
  const auto lock = claim_directory(c.out, c.force,
                                    {"recovery", identity_of(origin),
                                     with_figures({"recovery.csv", "recovery.txt"}, {"recovery"})});
  const std::vector<RecoveryRow> rows = recover(scenario, r);
  progress.clear();
  if constexpr (kDraws) draw_recovery(rows, origin, c.out, job.style);
  std::cout << recovery_text(rows) << std::flush;
  std::cerr << "results in " << c.out << "\n";
  return Exit::done;
}

}  // namespace

int calibrate_verb(const Arguments& arguments, const Host& host) {
  VerbOptions options("calibrate", "EXPERIMENT.toml...",
                      "Estimates the model's parameters from an experiment's recordings, with "
                      "intervals, parameters that the data do not constrain, and the fit of the "
                      "calibrated model.");
  CalibrateJob job;
  CalibrationOptions& c = job.calibration;
  add_calibrate_options(options, job);
  if (!options.parse(arguments, "of what? write lilytank calibrate EXPERIMENT.toml")) {
    return Exit::done;
  }
  if (!options.has("recover")) {
    options.refuse_given({"duration", "recordings"}, "goes with --recover");
  }
  refuse_point_bodies(options.positional());
  complete(options, job);
  Progress progress(job.quiet, host);
  progress.watch(c);
  if (options.has("recover")) return recover_verb(options, arguments, job, progress);
  std::vector<std::string> files = options.positional();
  const Experiment experiment = load_experiment(files, job.sets);
  if (job.objective.empty()) c.objective = default_objective(experiment, c.body, c.parameters);
  std::vector<double> truth;
  for (const auto& [name, values] : {std::pair{"start", &c.start}, {"truth", &truth}}) {
    if (!options.has(name)) continue;
    *values = values_with(options.positional(), options.text(name), job.sets, c.parameters);
    files.push_back(options.text(name));
  }
  c.out = options.out("out/calibrate-" + experiment.name);
  if (options.has("dry-run")) {
    const CalibrationPlan plan = plan_calibration(experiment, c);
    print_shortfalls(plan.coverage);
    std::cout << "would calibrate " << experiment.name << ": " << plan_line(plan) << "; in "
              << c.out << "\n";
    return Exit::done;
  }
  c.covered = print_shortfalls;
  if (!job.quiet) {
    c.planned = [](const CalibrationPlan& plan) { std::cerr << plan_line(plan) << "\n"; };
  }
  std::shared_ptr<const DirectoryLock> lock;  // until the report is written
  c.lock = &lock;
  CalibrationResult found = calibrate(experiment, c);
  for (std::size_t i = 0; i < truth.size(); ++i) found.parameters[i].truth = truth[i];
  progress.clear();
  ReportDocument report = calibration_report(found);
  for (const RecordingSource& source : experiment.sources) files.push_back(source.file);
  report.provenance = provenance("calibrate", arguments, c.seed, files);
  write_calibration(found, report, c.out);
  if constexpr (kDraws) draw_calibration(found, report, c.out, job.style);
  if constexpr (!kDraws) say_undrawn("plots");
  return print_results(report, c.out, host);
}

}  // namespace lilytank::cli
