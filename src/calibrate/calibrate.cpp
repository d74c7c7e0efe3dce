#include "lilytank/calibration.hpp"

#include <algorithm>
#include <cmath>

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
  out.dt = setup.model.dt, out.tank_radius = setup.model.tank.radius;
  for (const RecordingShape& shape : setup.shapes) {
    out.bodies = std::max(out.bodies, shape.bodies);
    out.seconds += shape.frames / shape.rate;
  }
  for (std::size_t i = 0; i < setup.parameters.size(); ++i) {
    CalibratedParameter p;
    p.parameter = setup.parameters[i], p.start = setup.start[i];
    out.parameters.push_back(std::move(p));
  }
  out.coverage = coverage_of(setup.flow ? &*setup.flow : nullptr, setup.balls, setup.training);
  if (setup.options.covered) setup.options.covered(out.coverage);
  out.conditions = fit_conditions(setup.model, setup.body, setup.paths());
  return out;
}

}  // namespace

CalibrationResult calibrate(const Experiment& experiment, const CalibrationOptions& options) {
  CalibrationSetup setup = set_up(experiment, options);
  const auto lock = claim_directory(
      options.out, options.force, {"calibration", "1 " + hex(setup.identity), calibration_files()});
  if (options.lock != nullptr) *options.lock = lock;
  Stages stages(setup);
  CalibrationResult out = begun(setup);
  const FlowMaps maps = stages.flow_maps();
  out.flow_csv = setup.corrected_csv(*maps.best());
  const std::vector<double> searched = stages.search(out);
  for (std::size_t i = 0; i < searched.size(); ++i) out.parameters[i].searched = searched[i];
  const std::vector<double> recorded = setup.numbers(setup.training);
  const Eigen::VectorXd observed = Eigen::Map<const Eigen::VectorXd>(
      recorded.data(), static_cast<Eigen::Index>(recorded.size()));
  const LocalAnswer answer = find_locally(stages, searched, maps, observed, out);
  out.rounds = answer.rounds;
  find_intervals(stages, answer, maps, observed, out);
  if (options.comparisons > 0) compare_with_data(stages, out);
  out.simulations = stages.simulations();
  return out;
}

}  // namespace lilytank
