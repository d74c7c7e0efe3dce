#include "finder/prepared_tank.hpp"

#include <algorithm>
#include <cmath>

#include "calibrate/design.hpp"
#include "finder/joint.hpp"
#include "lilytank/random.hpp"
#include "scores/nuisances.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kMostCentres = 5;
constexpr double kAnswerReach = 2.5;  // deviations of the points that an answer may be off
constexpr double kStays = 1.5;        // deviations of the points
// Deviations of designs: shares of the parameters' ranges, and standard errors. Points closer than
// the errors would hardly constrain slopes, and errors from such slopes would be too small.
constexpr double kFirstSpread = 0.05, kLeastPointSpread = 0.015, kMostPointSpread = 0.08;
constexpr double kWiderThanError = 2, kWideEnough = 1.5, kNullsWide = 2;
constexpr std::uint64_t kEnsembleSeed = 31, kNuisanceSeed = 32, kCentreSeed = 3000;

// The flow maps, after which the rest of the work is known.
FlowMaps flow_maps(DiagnosisSetup& setup, double after) {
  FlowMaps maps = setup.stages.flow_maps();
  const DiagnosisBudget& budget = setup.budget;
  double effects = 0;
  for (const Effect& e : effect_catalogue(setup.calibration.model)) {
    effects += budget.learning.in_all(e);
  }
  setup.stages.expect(2 * budget.centre + budget.nulls + effects + after);
  return maps;
}

Vector range_of(const FitBounds& bounds) {
  return bounds.high - bounds.low;
}

}  // namespace

PreparedTank::PreparedTank(DiagnosisSetup& diagnosis, double after)
    : setup(diagnosis),
      maps(flow_maps(diagnosis, after)),
      baseline(estimate_baseline()),
      spread(null_spread()),
      ensemble(setup.stages, maps, plan(), baseline.point, spread,
               {setup.budget.nulls, setup.budget.learning,
                derived_seed(setup.options.seed, kEnsembleSeed), setup.options.seed}),
      selection(ensemble.null_residuals(), correlations_of(ensemble.informations()),
                ensemble.plan().effects, ensemble.fingerprints(), ensemble.plan().shapes.size(),
                setup.options.false_alarms) {}

// Designs are centred at the last estimate until the next estimate lies among their points. They
// start at the experiment's model: a global search would find a baseline that imitates an omitted
// effect.
BaselineEstimate PreparedTank::estimate_baseline() const {
  const FitBounds bounds = setup.stages.bounds();
  BaselineEstimate now{setup.stages.to_scale(setup.calibration.start),
                       kFirstSpread / kWiderThanError * range_of(bounds), false};
  for (int round = 1; round <= kMostCentres && !now.settled; ++round) {
    now = moved_to(now, round, bounds);
  }
  return now;
}

// By whole experiments, simulated about the last estimate in proportion to its errors.
BaselineEstimate PreparedTank::moved_to(const BaselineEstimate& before, int round,
                                        const FitBounds& bounds) const {
  const CalibrationSetup& calibration = setup.calibration;
  const Vector range = range_of(bounds);
  const Vector wide = (kWiderThanError * before.deviation)
                          .cwiseMax(kFirstSpread * range)
                          .cwiseMin(kMostPointSpread * range);
  const std::uint64_t seed =
      derived_seed(setup.options.seed, kCentreSeed + static_cast<std::uint64_t>(round));
  const Matrix points =
      scattered(before.point, wide.asDiagonal(), setup.budget.centre, bounds, seed);
  const ResponseSurface model(
      design_of(points, setup.stages.simulate("baseline, round " + std::to_string(round), points,
                                              seed, maps)),
      Misfit::covariance, Slopes::shrunk);
  const std::vector<double> numbers = calibration.numbers(calibration.training);
  FitBounds near = bounds;
  near.reach = kAnswerReach;
  // Statistics that the baseline does not explain must not move its parameters.
  const MapEstimate known =
      model.fit(Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size())),
                near, {setup.stages.to_scale(calibration.start), kPrior * range});
  const LocalFit& fit = known.fit;
  const Vector moved = (fit.point - before.point).cwiseQuotient(wide);
  const Vector deviation = known.covariance.diagonal().cwiseSqrt();
  const bool enough =
      (kWideEnough * deviation.cwiseMin(kMostPointSpread / kWideEnough * range) - wide).maxCoeff() <
      1e-9;
  return {fit.point, deviation, enough && !fit.at_bound && moved.cwiseAbs().maxCoeff() < kStays};
}

Matrix PreparedTank::null_spread() const {
  const Vector range = range_of(setup.stages.bounds());
  return (kNullsWide * baseline.deviation)
      .cwiseMax(kLeastPointSpread * range)
      .cwiseMin(kMostPointSpread * range)
      .asDiagonal();
}

Model PreparedTank::baseline_at(const Vector& scaled) const {
  return setup.calibration.model_at(setup.stages.from_scale(scaled));
}

ScorePlan PreparedTank::plan() const {
  const CalibrationSetup& calibration = setup.calibration;
  ScorePlan p;
  p.model = baseline_at(baseline.point);
  p.predictor = predictor_options(p.model, calibration.training);
  p.effects = effect_catalogue(calibration.model);
  double longest = 0;
  for (const Recording& r : calibration.training) longest = std::max(longest, r.frames / r.rate);
  const int known = identities_in(calibration.training);
  const int later = identities_in(calibration.held_out);
  const int bodies = most_bodies(calibration.shapes);
  p.identities = known <= bodies && later <= most_bodies(calibration.held_out_shapes);
  if (!p.identities) {
    std::erase_if(p.effects, [](const Effect& e) { return e.estimated == Estimated::module; });
  }
  p.shapes = shape_catalogue(p.model, longest);
  p.nuisances = std::make_shared<const Nuisances>(
      p.model, maps, derived_seed(setup.options.seed, kNuisanceSeed), setup.options.threads);
  p.rate = calibration.training.front().rate;
  p.logged = p.latched() && std::ranges::all_of(calibration.shapes, [](const RecordingShape& s) {
               return s.logged || !s.latches;
             });
  p.modules = std::max({bodies, known, later});
  return p;
}

}  // namespace lilytank
