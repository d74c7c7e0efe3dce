#include "finder/joint.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "calibrate/cross_fit.hpp"
#include "calibrate/design.hpp"
#include "calibrate/estimate_line.hpp"
#include "finder/joint_parameters.hpp"
#include "lilytank/random.hpp"
#include "scores/flow_uncertainty.hpp"
#include "statistics/linear.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kMostRounds = 5;
constexpr double kSettled = 1;       // deviations of the design
constexpr double kJointReach = 2.5;  // likewise, that an answer may be off
// Widths of designs in errors of the estimate (narrower ones have noisy slopes), and their bound as
// a share of the parameters' ranges.
constexpr double kJointWiderThanError = 1.5, kJointWideEnough = 0.67, kMostJointSpread = 0.1;
constexpr double kOverlap = 2;    // deviations a parameter from the centre up to which points count
constexpr double kLater = 0.625;  // of a round, where others are near
constexpr double kOtherWidth = 1.5;
constexpr int kChecks = 60;  // experiments at the answer
constexpr std::uint64_t kMix = 7, kCheckSeed = 1000;

// Where an effect with a place is scored for the joint fit: where the fit begins, a width away in
// each direction, and with other widths, which shows where it is to go.
std::vector<Effect> about_place(const Effect& effect) {
  const double x = effect.held[0].value, y = effect.held[1].value, width = effect.held[2].value;
  std::vector<Effect> out{effect};
  for (const double step : {-width, width}) {
    out.push_back(placed(effect, x + step, y, width));
    out.push_back(placed(effect, x, y + step, width));
  }
  for (const double factor : {1 / kOtherWidth, kOtherWidth}) {
    out.push_back(placed(effect, x, y, factor * width));
  }
  return out;
}

// Statistics of the joint fit: summary, named scores, scores of the fitted curves, and of effects
// about their places, standardised. Scores of effects are decorrelated by their expected
// correlations, which few simulations could not estimate.
class Numbers {
 public:
  Numbers(const ReferenceEnsemble& ensemble, const std::vector<JointEffect>& effects)
      : ensemble_(ensemble), plan_(ensemble.plan()), places_(ensemble.plan()) {
    plan_.shapes.clear(), places_.effects.clear(), places_.shapes.clear();
    for (const JointEffect& e : effects) {
      if (e.effect.estimated != Estimated::place) continue;
      for (Effect& one : about_place(e.effect)) places_.effects.push_back(std::move(one));
    }
    std::vector<Eigen::Index> scored;
    for (Eigen::Index k = 0; k < ensemble.named_numbers(); ++k) scored.push_back(k);
    for (const JointEffect& e : effects) {
      if (e.shape < 0) continue;
      plan_.shapes.push_back(ensemble.plan().shapes[static_cast<std::size_t>(e.shape)]);
      for (int k = 0; k < kKnots; ++k) {
        scored.push_back(ensemble.named_numbers() + e.shape * kKnots + k);
      }
    }
    deviations_ = ensemble.deviations()(scored);
    Matrix alike = correlations_of(ensemble.informations());
    alike.diagonal().array() += kUniqueVariance;
    alike_ = lower_root(alike);
  }
  /// Those of `all` that do not depend on these parameters (Design::independent): only scores about
  /// its place show where and how strong an effect is, to first order about the design's centre;
  /// slopes of hundreds of others would be noise.
  Matrix independent_of(const std::vector<Eigen::Index>& placed, Eigen::Index all,
                        Eigen::Index parameters) const {
    if (placed.empty()) return {};
    Matrix out = Matrix::Zero(all, parameters);
    for (const Eigen::Index k : placed) out.col(k).head(all - own_numbers()).setOnes();
    return out;
  }
  Vector operator()(const std::vector<Recording>& recordings) const {
    const Vector summary = ensemble_.summary(recordings), places = about_places(recordings);
    const std::vector<double> scores = score(plan_, recordings);
    Vector out(summary.size() + deviations_.size() + places.size());
    out << summary,
        Eigen::Map<const Vector>(scores.data(), deviations_.size()).cwiseQuotient(deviations_),
        places;
    auto own = out.segment(summary.size(), alike_.rows());
    own = solve_lower(alike_, own);
    return out;
  }

 private:
  Vector about_places(const std::vector<Recording>& recordings) const {
    if (places_.effects.empty()) return {};
    const auto scored = scored_amplitudes(places_, recordings);
    Vector out(static_cast<Eigen::Index>(scored.size()));
    for (Eigen::Index k = 0; k < out.size(); ++k) {
      out(k) = scored[static_cast<std::size_t>(k)].drawn(kScoreKnown);
    }
    return out;
  }

  Eigen::Index own_numbers() const {
    return static_cast<Eigen::Index>(places_.first_of_effect(places_.effects.size()));
  }

  const ReferenceEnsemble& ensemble_;
  ScorePlan plan_, places_;  ///< with the fitted curves alone; with effects about their places
  Matrix alike_;
  Vector deviations_;  ///< of the plan's scores
};

class Joint {
 public:
  Joint(Stages& stages, const FlowMaps& maps, const ReferenceEnsemble& ensemble,
        const Numbers& numbers, JointFit& fit)
      : stages_(stages),
        maps_(maps),
        ensemble_(ensemble),
        numbers_(numbers),
        fit_(fit),
        emulator_(fit.model, paths(fit), stages.setup().shapes, {.moment_matched = false}) {}

  /// `tag`: of the recordings.
  Design simulate(const std::string& tag, const std::string& round, const Matrix& points,
                  std::uint64_t seed) {
    // The cache key covers the start of the fit, too.
    Fnv place;
    for (const FitParameter& p : fit_.parameters) place.add(p.path);
    place.add(std::span(points.data(), static_cast<std::size_t>(points.size())));
    const std::string key = "joint " + tag + " " + round + " " + hex(place.value());
    const auto row = [&](int i) {
      const auto field = perturbed_flow(maps_, derived_seed(seed, kMix), seed, i);
      const auto made = emulator_.record(
          values(points.row(i)), derived_seed(seed, 16 + static_cast<std::uint64_t>(i)), field);
      if (!made) return std::vector<double>{};
      const Vector all = numbers_(*made);
      return std::vector<double>(all.begin(), all.end());
    };
    const int count = static_cast<int>(points.rows());
    return design_of(points, stages_.rows("joint fit, " + round, {{key, count, row}}).front());
  }
  std::vector<double> values(const Vector& point) const {
    std::vector<double> out;
    for (std::size_t i = 0; i < fit_.parameters.size(); ++i) {
      const FitParameter& p = fit_.parameters[i];
      out.push_back(std::clamp(p.from_scale(point(static_cast<Eigen::Index>(i))), p.low, p.high));
    }
    return out;
  }

 private:
  static std::vector<std::string> paths(const JointFit& fit) {
    std::vector<std::string> out;
    for (const FitParameter& p : fit.parameters) out.push_back(p.path);
    return out;
  }
  Stages& stages_;
  const FlowMaps& maps_;
  const ReferenceEnsemble& ensemble_;
  const Numbers& numbers_;
  JointFit& fit_;
  Emulator emulator_;
};

Vector vector_of(const std::vector<double>& of) {
  return Eigen::Map<const Vector>(of.data(), static_cast<Eigen::Index>(of.size()));
}

// Appends the rows of `more`.
void append(const Design& more, Design& all) {
  if (all.points.size() == 0) {
    all = more;
    return;
  }
  const Eigen::Index before = all.points.rows();
  all.points.conservativeResize(before + more.points.rows(), Eigen::NoChange);
  all.numbers.conservativeResize(before + more.points.rows(), Eigen::NoChange);
  all.points.bottomRows(more.points.rows()) = more.points;
  all.numbers.bottomRows(more.points.rows()) = more.numbers;
}

// Simulations of all rounds within the design about the centre.
Design about(const Design& all, const Vector& centre, const Matrix& width) {
  if (all.points.size() == 0) return all;
  std::vector<Eigen::Index> near;
  const Vector inverse = width.diagonal().cwiseInverse();
  for (Eigen::Index i = 0; i < all.points.rows(); ++i) {
    const Vector off = inverse.cwiseProduct(all.points.row(i).transpose() - centre);
    if (off.squaredNorm() <= kOverlap * kOverlap * static_cast<double>(off.size())) {
      near.push_back(i);
    }
  }
  return {all.points(near, Eigen::all), all.numbers(near, Eigen::all), all.independent};
}

void set_interval(const ParameterEstimate& answer, JointFit& fit) {
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const FitParameter& p = fit.parameters[i];
    const double middle = answer.estimate(k), half = answer.wide * answer.deviation(k);
    const auto within = [&](double v) { return std::clamp(p.from_scale(v), p.low, p.high); };
    fit.value.push_back(within(middle));
    fit.low.push_back(within(middle - half)), fit.high.push_back(within(middle + half));
  }
}

// Moves the design to the estimate, within its own bounds, with a width in proportion to the
// errors but not more than `most`. True if it was there already.
bool settled(const ParameterEstimate& answer, const FitBounds& bounds, const Vector& most,
             Vector& centre, Matrix& width) {
  const Vector reach = kJointReach * width.diagonal();
  const Vector next = answer.estimate.cwiseMax(bounds.low).cwiseMin(bounds.high);
  const Vector moved = (next - centre).cwiseQuotient(width.diagonal());
  const Vector wide = (kJointWiderThanError * answer.deviation).cwiseMin(most);
  const bool stays = moved.cwiseAbs().maxCoeff() < kSettled;
  const bool enough = (kJointWideEnough * wide - width.diagonal()).maxCoeff() < 0;
  if (stays && enough) return true;
  centre = next.cwiseMax(centre - reach).cwiseMin(centre + reach);
  width.diagonal() = width.diagonal().cwiseMax(wide);
  return false;
}

// Rounds of simulations, each about the estimate of the last one.
class Rounds {
 public:
  Rounds(Stages& stages, const FlowMaps& maps, const ReferenceEnsemble& ensemble,
         std::vector<JointEffect> effects, const std::vector<Recording>& recordings,
         JointStart baseline, JointRounds rounds)
      : stages_(stages),
        maps_(maps),
        ensemble_(ensemble),
        effects_(std::move(effects)),
        numbers_(ensemble, effects_),
        data_(numbers_(recordings)),
        baseline_(std::move(baseline)),
        rounds_(std::move(rounds)) {
    for (std::size_t e = 0; e < effects_.size(); ++e) fit_.kept.push_back(e);
    begin_anew();
  }

  JointFit run() {
    InverseRegression last;
    Design design;
    int most = kMostRounds;
    for (int k = 1; k <= most && !fit_.settled; ++k) {
      design = simulated(k);
      const Prior prior = known_before();
      if (drops_one(design, prior)) {
        ++most;
        continue;
      }
      last = inverse_regression(design, centre_, prior, data_);
      fit_.settled = settled(last.answer, bounds_, most_, centre_, width_);
    }
    set_interval(check(last, design), fit_);
    return std::move(fit_);
  }

 private:
  void begin_anew() {
    const Beginning begun = begin(stages_, effects_, baseline_, fit_);
    bounds_ = bounds_of(fit_);
    begun_ = vector_of(begun.at).cwiseMax(bounds_.low).cwiseMin(bounds_.high);
    known_ = vector_of(begun.known);
    centre_ = begun_, width_ = vector_of(begun.wide).asDiagonal();
    most_ = kMostJointSpread * (bounds_.high - bounds_.low);
    // A wider design would not be linear in the place.
    const std::vector<Eigen::Index> placed = placed_parameters(stages_, effects_);
    for (const Eigen::Index k : placed) most_(k) = width_(k, k);
    independent_ = numbers_.independent_of(placed, data_.size(), centre_.size());
    joint_.emplace(stages_, maps_, ensemble_, numbers_, fit_);
    all_ = {};
  }

  // Prior of the joint fit: the calibration for the baseline, the selection for amplitudes, the
  // first design for ranges, times and places; never narrower than the design.
  Prior known_before() const {
    Prior out{centre_, (kPrior * (bounds_.high - bounds_.low)).cwiseMin(known_)};
    out.deviation = out.deviation.cwiseMax(width_.diagonal());
    out.expected.head(baseline_.expected.size()) = baseline_.expected;
    for (Eigen::Index k = 0; k < known_.size(); ++k) {
      if (std::isfinite(known_(k))) out.expected(k) = begun_(k);
    }
    return out;
  }

  // The estimate and its errors from experiments at the last estimate, which are estimated as the
  // data are. Those of the design scatter more, as errors of slopes and nonlinearity grow with the
  // distance from its centre.
  ParameterEstimate check(const InverseRegression& last, const Design& design) {
    const Vector at = last.answer.estimate.cwiseMax(bounds_.low).cwiseMin(bounds_.high);
    const std::uint64_t seed = derived_seed(rounds_.seed, kCheckSeed);
    const Matrix points = at.transpose().replicate(kChecks, 1);
    const Design made = joint_->simulate(rounds_.tag, "at the estimate", points, seed);
    return anchored(last, design, at, made.numbers, known_before(), data_).answer;
  }

  // Simulations of all rounds about the centre.
  Design simulated(int k) {
    const std::uint64_t seed = derived_seed(rounds_.seed, static_cast<std::uint64_t>(k));
    // Earlier rounds at the same place reduce the number of new simulations.
    const bool known_ground = 2 * about(all_, centre_, width_).points.rows() >= rounds_.count;
    const int count = known_ground ? static_cast<int>(kLater * rounds_.count) : rounds_.count;
    append(joint_->simulate(rounds_.tag, "round " + std::to_string(k),
                            scattered(centre_, width_, count, bounds_, seed), seed),
           all_);
    all_.independent = independent_;
    return about(all_, centre_, width_);
  }

  // Whether the data no longer support an effect; the fit then restarts without it.
  bool drops_one(const Design& design, const Prior& prior) {
    FitBounds near = bounds_;
    near.reach = kJointReach;
    const ResponseSurface model(design, Misfit::covariance, Slopes::shrunk);
    const MapEstimate known = model.fit(data_, near, prior);
    Vector point = known.fit.point;
    const std::size_t dropped = least_supported(
        stages_, effects_, known.covariance / known.dispersion, rounds_.keep, point);
    if (dropped == effects_.size()) return false;
    read_point(stages_, point, effects_);
    const auto at = static_cast<std::ptrdiff_t>(dropped);
    effects_.erase(effects_.begin() + at), fit_.kept.erase(fit_.kept.begin() + at);
    baseline_.point = point.head(baseline_.point.size());
    begin_anew();
    return true;
  }

  Stages& stages_;
  const FlowMaps& maps_;
  const ReferenceEnsemble& ensemble_;
  std::vector<JointEffect> effects_;
  Numbers numbers_;  ///< of all effects that were found, also of those that are dropped
  Vector data_;
  JointStart baseline_;
  JointRounds rounds_;
  JointFit fit_;
  Vector begun_, known_;  ///< the first design's centre; see Beginning
  Vector most_;           ///< widths that no design exceeds
  Matrix independent_;
  Vector centre_;
  Matrix width_;
  FitBounds bounds_;
  std::optional<Joint> joint_;
  Design all_;
};

}  // namespace

JointFit fit_jointly(Stages& stages, const FlowMaps& maps, const ReferenceEnsemble& ensemble,
                     std::vector<JointEffect> effects, const std::vector<Recording>& recordings,
                     const JointStart& baseline, const JointRounds& rounds) {
  return Rounds(stages, maps, ensemble, std::move(effects), recordings, baseline, rounds).run();
}

}  // namespace lilytank
