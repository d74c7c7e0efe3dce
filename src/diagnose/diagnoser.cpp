#include "diagnose/diagnoser.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "calibrate/design.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/random.hpp"
#include "lilytank/state.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kMostCentres = 4;
constexpr double kStrong = 10;  // z above which fingerprints must be sharper than they are
constexpr double kLeastAmplitude = 0.2, kRival = 0.5, kNear = 0.85;
constexpr double kLearned = 2;  // sizes up to which a fingerprint is as good as it was learned
constexpr int kRivals = 3, kMostSharpened = 6;
constexpr double kStays = 1.5;                               // deviations of the points
constexpr double kFirstSpread = 0.04, kLeastSpread = 0.015;  // of designs, shares of the ranges

CalibrationOptions calibration_of(const Experiment& experiment, const DiagnosisOptions& o,
                                  const DiagnosisBudget& budget) {
  CalibrationOptions c;
  c.parameters = standard_parameters(BodyKind::lily);
  const bool told = std::any_of(experiment.recordings.begin(), experiment.recordings.end(),
                                [](const Recording& r) { return r.held_out; });
  const auto lilies = std::count_if(experiment.recordings.begin(), experiment.recordings.end(),
                                    [](const Recording& r) { return r.body == BodyKind::lily; });
  c.hold_out = told || lilies < 2 ? 0 : std::min(o.hold_out, static_cast<int>(lilies) - 1);
  c.search_budget = budget.search, c.flow_draws = budget.flow_draws;
  c.round = budget.centre, c.seed = o.seed, c.out = o.out, c.force = o.force;
  c.threads = o.threads, c.stop = o.stop, c.progress = o.progress;
  return c;
}

std::uint64_t fnv_of(const Vector& numbers) {
  Fnv hash;
  hash.add({reinterpret_cast<const char*>(numbers.data()),
            static_cast<std::size_t>(numbers.size()) * sizeof(double)});
  return hash.value();
}

}  // namespace

DiagnosisBudget::DiagnosisBudget(double minutes) {
  const double s = std::clamp(minutes / 10, 0.3, 4.0);
  const auto scaled = [&](int n, int least) {
    return std::max(least, static_cast<int>(std::lround(n * s)));
  };
  search = scaled(1500, 1000), flow_draws = scaled(12, 12), centre = 70;
  nulls = scaled(200, 160), experiments = scaled(6, 6), round = scaled(110, 110);
  replicates = scaled(50, 40), comparisons = scaled(16, 12);
}

Diagnoser::Diagnoser(const Experiment& experiment, const DiagnosisOptions& options)
    : options_(options),
      budget_(options.minutes),
      setup_(set_up(experiment, calibration_of(experiment, options, budget_))),
      stages_(begin(setup_, options)) {}

double Diagnoser::model_cost() const {
  return 2 * budget_.round + budget_.replicates + 2 * budget_.comparisons;
}

void Diagnoser::prepare(double after) {
  maps_.emplace(stages_.flow_maps());
  CalibrationResult searched;
  const Vector first = stages_.to_scale(stages_.search(searched));
  const FitBounds bounds = stages_.bounds();
  double effects = 0;
  for (const Effect& e : effect_catalogue(setup_.model)) {
    effects += budget_.experiments * static_cast<double>(e.paths.size());
  }
  stages_.expect(2 * budget_.centre + budget_.nulls + effects + after);
  // Points about the answer before, until the answer stays among them.
  Centre now{first, {}, false};
  for (int round = 1; round <= kMostCentres && !now.settled; ++round) {
    now = centre_of(now.point, round, *maps_, bounds);
  }
  const Vector &centre = now.point, &deviation = now.deviation;
  spread_ = (4 * deviation).cwiseMax(kLeastSpread * (bounds.high - bounds.low)).asDiagonal();
  atlas_ = std::make_unique<Atlas>(
      stages_, *maps_, plan(centre), centre, spread_,
      AtlasOptions{budget_.nulls, budget_.experiments, derived_seed(options_.seed, 31)});
  naming_ = std::make_unique<Naming>(*atlas_, options_.false_alarms);
}

Judged Diagnoser::judge(const std::vector<Recording>& recordings, Diagnosis& out) {
  Judged measured;
  measured.observed = atlas_->vectors(recordings, &measured.details);
  return judge(std::move(measured), out);
}

Judged Diagnoser::judge(Judged j, Diagnosis& out) {
  const Vector residual = atlas_->residual(j.observed);
  j.tag = hex(fnv_of(j.observed.scores));
  Naming naming = *naming_;
  j.explanation = sharpened(naming, explained(naming, residual), j, residual);
  tell_ranking(naming, residual, j.explanation, out);
  tell_detectable(naming, out);
  tell_findings(naming, residual, j.explanation, out);
  return j;
}

void Diagnoser::run(Diagnosis& out) {
  prepare(model_cost());
  out.flow_csv = setup_.corrected_csv(*maps_->best());
  const Judged judged = judge(setup_.training, out);
  model_and_show(judged, setup_.held_out.empty() ? setup_.training : setup_.held_out, out);
}

Stages Diagnoser::begin(CalibrationSetup& setup, const DiagnosisOptions& options) {
  claim_directory(setup.options, "diagnosis",
                  "1 " + hex(setup.identity) + " " + shortest(options.minutes));
  return Stages(setup);
}

// The parameters of the baseline that whole experiments say, and their errors.
Diagnoser::Centre Diagnoser::centre_of(const Vector& first, int round, const FlowMaps& maps,
                                       const FitBounds& bounds) {
  const Vector wide = kFirstSpread * (bounds.high - bounds.low);
  const std::uint64_t seed = derived_seed(options_.seed, 3000 + static_cast<std::uint64_t>(round));
  const Matrix points = scattered(first, wide.asDiagonal(), budget_.centre, bounds, seed);
  const LocalModel model(
      design_of(points, stages_.simulate("centre " + std::to_string(round), points, seed, maps)));
  const std::vector<double> numbers = setup_.numbers(setup_.training);
  FitBounds near = bounds;
  near.reach = 2.5;
  const LocalFit fit = model.fit(
      Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size())), near);
  const Vector moved = (fit.point - first).cwiseQuotient(wide);
  return {fit.point, model.parameter_covariance(fit.point).diagonal().cwiseSqrt(),
          !fit.at_reach && moved.cwiseAbs().maxCoeff() < kStays};
}

ScorePlan Diagnoser::plan(const Vector& centre) const {
  ScorePlan p;
  const std::vector<double> values = stages_.from_scale(centre);
  const std::vector<std::string> paths = setup_.paths();
  const auto told = static_cast<std::ptrdiff_t>(setup_.told());
  p.model =
      with_parameters(setup_.model, std::vector<std::string>(paths.begin(), paths.begin() + told),
                      std::vector<double>(values.begin(), values.begin() + told));
  p.predictor = predictor_options(p.model, setup_.training);
  p.effects = effect_catalogue(setup_.model);
  double longest = 0;
  int modules = 0;
  for (const Recording& r : setup_.training) {
    longest = std::max(longest, r.frames / r.rate);
    modules = std::max(modules, static_cast<int>(r.tracks.size()));
  }
  p.shapes = shape_catalogue(setup_.model, longest);
  p.rate = setup_.training.front().rate, p.modules = std::max(modules, setup_.shapes[0].bodies);
  return p;
}

// Named effects first; a shape competes with them where they leave something.
Explanation Diagnoser::explained(Naming& naming, const Vector& residual) {
  Explanation e = naming.explain(residual);
  const std::vector<EffectFit> shapes = naming.shapes(residual);
  std::vector<int> asked;
  if (shapes[0].z > naming.shape_threshold() && (e.found.empty() || shapes[0].z > e.found[0].z)) {
    asked.push_back(shapes[0].shape);
  }
  double largest = 0;
  for (const EffectFit& f : e.found) largest = std::max(largest, f.z);
  if (e.left_shape.z > std::max(naming.shape_threshold(), 0.15 * largest)) {
    if (asked.empty() || asked[0] != e.left_shape.shape) asked.push_back(e.left_shape.shape);
  }
  for (const int s : asked) naming.add_shape(s, shape_fingerprint(s));
  return asked.empty() ? e : naming.explain(residual);
}

// One effect of a size like those that were simulated explains all there is, and nothing else
// comes near.
bool Diagnoser::plain(const Naming& naming, const Explanation& e, const Vector& residual) const {
  const EffectFit& f = e.found.front();
  if (e.found.size() > 1 || f.effect < 0 || f.amplitudes.cwiseAbs().maxCoeff() > kLearned) {
    return false;
  }
  const std::vector<Effect>& effects = atlas_->plan().effects;
  const std::string& name = effects[static_cast<std::size_t>(f.effect)].name;
  const std::vector<EffectFit> leading = naming.leading(residual, kRivals + 3);
  return std::none_of(leading.begin(), leading.end(), [&](const EffectFit& other) {
    const bool same =
        other.effect >= 0 && effects[static_cast<std::size_t>(other.effect)].name == name;
    return !same && other.gain > kNear * leading.front().gain;
  });
}

// Fingerprints are learned at sizes that can just be seen well; what is far stronger is judged by
// experiments of its own strength. First those that might be it, then whatever leads.
Explanation Diagnoser::sharpened(Naming& naming, Explanation e, const Judged& judged,
                                 const Vector& residual) {
  const Vector calibrated = atlas_->calibrated(judged.observed.summary).point;
  std::map<std::pair<int, int>, Fingerprint> known;
  std::uint64_t asked = 0;
  const auto sharpen = [&](const EffectFit& f) {
    const auto id = static_cast<std::size_t>(f.effect >= 0 ? f.effect : f.shape);
    const ScorePlan& plan = atlas_->plan();
    const Effect effect = f.effect >= 0 ? plan.effects[id] : effect_of(plan.shapes[id]);
    const auto before = known.find({f.effect, f.shape});
    const Fingerprint from = before != known.end() ? before->second
                             : f.effect >= 0       ? atlas_->fingerprints()[id]
                                                   : shape_fingerprint(f.shape);
    const std::string stage = "sharp " + judged.tag + " " + std::to_string(asked) +
                              (f.effect >= 0 ? " effect " : " shape ") + std::to_string(id);
    const Fingerprint to = atlas_->fingerprint_about(f.amplitudes, from, effect, calibrated, stage,
                                                     derived_seed(options_.seed, 900 + asked++));
    known[{f.effect, f.shape}] = to;
    naming.sharpen(f, to);
  };
  if (e.found.empty() || e.found[0].z < kStrong || plain(naming, e, residual)) return e;
  const auto blunt = [&](const EffectFit& f) {
    const bool told = known.count({f.effect, f.shape}) > 0;
    return f.amplitudes.norm() > kLeastAmplitude && (!told || (f.at_reach && f.effect >= 0));
  };
  for (const EffectFit& f : naming.leading(residual, kRivals)) {
    if (blunt(f)) sharpen(f);
  }
  for (int more = 0; more < kMostSharpened; ++more) {
    e = naming.explain(residual);
    std::vector<EffectFit> next = naming.leading(residual, kRivals);
    next.erase(std::remove_if(next.begin() + 1, next.end(),
                              [&](const EffectFit& f) { return f.gain < kRival * next[0].gain; }),
               next.end());
    for (const EffectFit& f : e.found) {
      if (f.z >= kStrong) next.push_back(f);
    }
    const auto first = std::find_if(next.begin(), next.end(), blunt);
    if (first == next.end()) break;
    sharpen(*first);
  }
  return naming.explain(residual);
}

Fingerprint Diagnoser::shape_fingerprint(int s) {
  return atlas_->fingerprint(effect_of(atlas_->plan().shapes[static_cast<std::size_t>(s)]),
                             "shape " + std::to_string(s),
                             derived_seed(options_.seed, 500 + static_cast<std::uint64_t>(s)));
}

}  // namespace lilytank
