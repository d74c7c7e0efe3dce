#include "lilytank/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "calibrate/fit_conditions.hpp"
#include "calibrate/stages.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/state.hpp"

namespace lilytank {
namespace {

CalibrationResult begun(const CalibrationSetup& setup) {
  CalibrationResult out;
  out.name = setup.name, out.objective = name_of(setup.options.objective);
  out.flow = setup.flow ? setup.flow->name : "scenario";
  out.search_name = setup.options.search_name, out.body = setup.body;
  out.recordings = static_cast<int>(setup.training.size());
  out.bodies = most_bodies(setup.shapes);
  out.dt = setup.model.dt, out.tank_radius = setup.model.tank.radius;
  for (const RecordingShape& shape : setup.shapes) {
    out.seconds += shape.frames / shape.rate;
  }
  for (std::size_t i = 0; i < setup.parameters.size(); ++i) {
    CalibratedParameter p;
    p.parameter = setup.parameters[i], p.start = setup.start[i];
    out.parameters.push_back(std::move(p));
  }
  out.coverage = coverage_of(setup.flow ? &*setup.flow : nullptr, setup.balls, setup.training);
  out.conditions = fit_conditions(setup.model, setup.body, setup.paths());
  return out;
}

DirectoryJob job_of(const CalibrationSetup& setup) {
  return {"calibration", "1 " + hex(setup.identity), calibration_files()};
}

// Processor time of this thread, s. For plans alone: no result depends on it.
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double time_of(Work&& work) {
  const double begin = processor_time();
  static_cast<void>(work());
  return processor_time() - begin;
}

CalibrationPlan plan_of(const CalibrationSetup& setup, const Stages& stages) {
  CalibrationPlan out;
  out.coverage = coverage_of(setup.flow ? &*setup.flow : nullptr, setup.balls, setup.training);
  out.recordings = static_cast<int>(setup.training.size());
  out.bodies = most_bodies(setup.shapes);
  out.experiments = stages.usual_experiments();
  out.experiment_time = time_of([&] {
    return setup.emulator(setup.shapes, CalibrationSetup::Of::experiments).record(setup.start, 1);
  });
  if (setup.predicted()) {
    const ScorePlan plan = prediction_plan(setup.model, setup.training, out.bodies);
    out.experiment_time += time_of([&] { return prediction_numbers(plan, setup.training); });
  }
  if (setup.draws_flow()) {
    out.extractions = setup.options.flow_draws;
    out.extraction_time = time_of(
        [&] { return redraw_flow(*setup.flow, setup.balls, setup.ball, FlowOptions{}, 1, 0); });
  }
  return out;
}

}  // namespace

CalibrationPlan plan_calibration(const Experiment& experiment, const CalibrationOptions& options) {
  CalibrationSetup setup = set_up(experiment, options);
  check_directory(options.out, options.force, job_of(setup));
  return plan_of(setup, Stages(setup));
}

CalibrationResult calibrate(const Experiment& experiment, const CalibrationOptions& options) {
  CalibrationSetup setup = set_up(experiment, options);
  const auto lock = claim_directory(options.out, options.force, job_of(setup));
  if (options.lock != nullptr) *options.lock = lock;
  Stages stages(setup);
  CalibrationResult out = begun(setup);
  if (options.covered) options.covered(out.coverage);
  if (options.planned) options.planned(plan_of(setup, stages));
  const FlowMaps maps = stages.flow_maps();
  out.flow_csv = setup.corrected_csv(*maps.best());
  const std::vector<double> searched = stages.search(out);
  for (std::size_t i = 0; i < searched.size(); ++i) out.parameters[i].searched = searched[i];
  const LocalAnswer answer = find_locally(stages, searched, maps, out);
  out.rounds = answer.rounds;
  find_intervals(stages, answer, maps, out);
  if (options.comparisons > 0) compare_with_data(stages, out);
  out.simulations = stages.simulations();
  return out;
}

}  // namespace lilytank
