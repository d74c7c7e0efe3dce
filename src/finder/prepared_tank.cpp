#include "finder/prepared_tank.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "calibrate/design.hpp"
#include "finder/nuisances.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/random.hpp"
#include "lilytank/state.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

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

CalibrationOptions calibration_of(const Experiment& experiment, const DiagnosisOptions& o,
                                  const DiagnosisBudget& budget) {
  CalibrationOptions c;
  c.parameters = standard_parameters(BodyKind::lily);
  const bool marked =
      std::any_of(experiment.recordings.begin(), experiment.recordings.end(),
                  [](const Recording& r) { return r.body == BodyKind::lily && r.held_out; });
  const auto lilies = std::count_if(experiment.recordings.begin(), experiment.recordings.end(),
                                    [](const Recording& r) { return r.body == BodyKind::lily; });
  c.hold_out = marked || lilies < 2 ? 0 : std::min(o.hold_out, static_cast<int>(lilies) - 1);
  c.flow_draws = budget.flow_draws;
  c.round = budget.centre, c.seed = o.seed, c.out = o.out, c.force = o.force;
  c.threads = o.threads, c.stop = o.stop, c.progress = o.progress;
  return c;
}

// Numbers of bodies, over all recordings.
int most_bodies(const std::vector<RecordingShape>& shapes) {
  int most = 0;
  for (const RecordingShape& shape : shapes) most = std::max(most, shape.bodies);
  return most;
}

int identities_in(const std::vector<Recording>& recordings) {
  std::set<std::int64_t> ids;
  for (const Recording& one : recordings) {
    for (const Track& track : one.tracks) ids.insert(track.id);
  }
  return static_cast<int>(ids.size());
}

std::uint64_t fnv_of(const Vector& numbers) {
  Fnv hash;
  hash.add(std::span(numbers.data(), static_cast<std::size_t>(numbers.size())));
  return hash.value();
}

}  // namespace

DiagnosisBudget::DiagnosisBudget(double minutes) {
  const double s = std::clamp(minutes / 10, 0.3, 4.0);
  const auto scaled = [&](int n, int least) {
    return std::max(least, static_cast<int>(std::lround(n * s)));
  };
  flow_draws = scaled(12, 12), centre = 70;
  nulls = scaled(240, 160), experiments = scaled(5, 5), round = scaled(80, 80);
  comparisons = scaled(16, 12);
}

Diagnoser::Diagnoser(const Experiment& experiment, const DiagnosisOptions& options)
    : options_(options),
      budget_(options.minutes),
      setup_(set_up(experiment, calibration_of(experiment, options, budget_))),
      stages_(setup_) {}

double Diagnoser::model_cost() const {
  return 3 * budget_.round + 2 * budget_.comparisons;
}

void Diagnoser::prepare(double after) {
  maps_.emplace(stages_.flow_maps());
  const FitBounds bounds = stages_.bounds();
  double effects = 0;
  for (const Effect& e : effect_catalogue(setup_.model)) {
    effects += budget_.experiments * static_cast<double>(e.paths.size());
  }
  stages_.expect(2 * budget_.centre + budget_.nulls + effects + after);
  // Designs are centred at the last estimate until the next estimate lies among their points. They
  // start at the experiment's model: a global search would find a baseline that imitates an omitted
  // effect.
  const Vector range = bounds.high - bounds.low;
  Centre now{stages_.to_scale(setup_.start), kFirstSpread / kWiderThanError * range, false};
  for (int round = 1; round <= kMostCentres && !now.settled; ++round) {
    now = centre_of(now, round, *maps_, bounds);
  }
  deviation_ = now.deviation;
  spread_ = (kNullsWide * now.deviation)
                .cwiseMax(kLeastPointSpread * range)
                .cwiseMin(kMostPointSpread * range)
                .asDiagonal();
  ensemble_ = std::make_unique<ReferenceEnsemble>(
      stages_, *maps_, plan(now.point), now.point, spread_,
      EnsembleOptions{budget_.nulls, budget_.experiments, derived_seed(options_.seed, 31)});
  selection_ = std::make_unique<ModelSelection>(
      ensemble_->null_residuals(), correlations_of(ensemble_->informations()),
      ensemble_->plan().effects, ensemble_->fingerprints(), ensemble_->plan().shapes.size(),
      options_.false_alarms);
}

Judged Diagnoser::judge(const std::vector<Recording>& recordings, Diagnosis& out) {
  Judged measured;
  measured.observed = ensemble_->vectors(recordings, &measured.details);
  return judge(std::move(measured), recordings, out);
}

Judged Diagnoser::judge(Judged j, const std::vector<Recording>& recordings, Diagnosis& out) {
  const Vector residual = ensemble_->residual(j.observed);
  j.tag = hex(fnv_of(j.observed.scores));
  ModelSelection selection = *selection_;
  ScoreSensitivity sensitivity(*ensemble_, recordings);
  selection.inflate_covariance(sensitivity.further_variance());
  const std::vector<Effect>& effects = ensemble_->plan().effects;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    EffectFit of;
    of.effect = static_cast<int>(e);
    selection.set_fingerprint(of, sensitivity.aligned(ensemble_->fingerprints()[e], effects[e]));
  }
  SelectedModel first = explained(selection, sensitivity, residual);
  Refined r = refined({std::move(first), std::move(selection), std::move(j.details)}, sensitivity,
                      j.observed, residual);
  report_ranking(r.selection, residual, r.model, out);
  report_detectable(r.selection, out);
  report_findings(r.selection, residual, r.model, out);
  j.selected = std::move(r.model), j.details = std::move(r.details);
  return j;
}

void Diagnoser::run(Diagnosis& out) {
  prepare(model_cost());
  out.flow_csv = setup_.corrected_csv(*maps_->best());
  out.modules =
      std::max({out.modules, most_bodies(setup_.shapes), most_bodies(setup_.held_out_shapes)});
  if (!ensemble_->plan().identities) {
    out.checks.push_back(
        "there are more identities than bodies: differences between modules, "
        "heterogeneous_module among them, are not tested");
  }
  out.nothing_held_out = setup_.held_out.empty();
  if (out.nothing_held_out) {
    out.warnings.push_back(
        "no recording was held out: what is shown of the fit is of recordings "
        "that it rests on, and says less than of others");
  }
  const Judged judged = judge(setup_.training, out);
  model_and_show(judged, setup_.held_out.empty() ? setup_.training : setup_.held_out, out);
}

std::string Diagnoser::identity() const {
  return "23 " + hex(setup_.identity) + " " + shortest(options_.minutes);
}

// The baseline's parameters and their errors from whole experiments, simulated about the last
// estimate in proportion to its errors.
Diagnoser::Centre Diagnoser::centre_of(const Centre& before, int round, const FlowMaps& maps,
                                       const FitBounds& bounds) {
  const Vector range = bounds.high - bounds.low;
  const Vector wide = (kWiderThanError * before.deviation)
                          .cwiseMax(kFirstSpread * range)
                          .cwiseMin(kMostPointSpread * range);
  const std::uint64_t seed = derived_seed(options_.seed, 3000 + static_cast<std::uint64_t>(round));
  const Matrix points = scattered(before.point, wide.asDiagonal(), budget_.centre, bounds, seed);
  const ResponseSurface model(
      design_of(points, stages_.simulate("centre " + std::to_string(round), points, seed, maps)),
      Misfit::covariance, Slopes::shrunk);
  const std::vector<double> numbers = setup_.numbers(setup_.training);
  FitBounds near = bounds;
  near.reach = kAnswerReach;
  // Statistics that the baseline does not explain must not move its parameters.
  const MapEstimate known =
      model.fit(Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size())),
                near, {stages_.to_scale(setup_.start), kPrior * range});
  const LocalFit& fit = known.fit;
  const Vector moved = (fit.point - before.point).cwiseQuotient(wide);
  const Vector deviation = known.covariance.diagonal().cwiseSqrt();
  const bool enough =
      (kWideEnough * deviation.cwiseMin(kMostPointSpread / kWideEnough * range) - wide).maxCoeff() <
      1e-9;
  return {fit.point, deviation, enough && !fit.at_bound && moved.cwiseAbs().maxCoeff() < kStays};
}

ScorePlan Diagnoser::plan(const Vector& centre) const {
  ScorePlan p;
  p.model = baseline_at(centre);
  p.predictor = predictor_options(p.model, setup_.training);
  p.effects = effect_catalogue(setup_.model);
  double longest = 0;
  for (const Recording& r : setup_.training) longest = std::max(longest, r.frames / r.rate);
  const int known = identities_in(setup_.training), later = identities_in(setup_.held_out);
  const int bodies = most_bodies(setup_.shapes);
  p.identities = known <= bodies && later <= most_bodies(setup_.held_out_shapes);
  if (!p.identities) {
    std::erase_if(p.effects, [](const Effect& e) { return e.estimated == Estimated::module; });
  }
  p.shapes = shape_catalogue(p.model, longest);
  p.nuisances_known = nuisances_known(p.model, *maps_, derived_seed(options_.seed, 32));
  p.rate = setup_.training.front().rate;
  p.modules = std::max({bodies, known, later});
  return p;
}

}  // namespace lilytank
