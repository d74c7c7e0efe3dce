// Fingerprints of effects and curves, by experiments with them.
#include <algorithm>
#include <cmath>

#include "calibrate/design.hpp"
#include "finder/reference_ensemble.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/random.hpp"
#include "statistics/linear.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"
#include "tracks/summary_parts.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::uint64_t kSharpSeed = 2, kEffectSeed = 100, kCurveSeed = 500;
// Width of designs about a finding relative to that of nulls: its parameters are known better.
constexpr double kNarrow = 0.6;
constexpr double kLeastVariance = 1e-6;
constexpr double kBend = 1;  // one over the square of a second order that is expected
// Ridge on the slopes of a fingerprint about estimated amplitudes (inverse of their expected
// squared error), and the degrees of freedom that such a slope takes.
constexpr double kSlopeKnown = 0.25, kSlopesFitted = 0.5;
// Power law of an effect's growth: significance over chance that it requires, least spread of the
// logarithms of the amplitudes, and largest power.
constexpr double kClearly = 0.5, kLeastScoreSpread = 0.03, kMostGrowth = 2.5;

// Power of the amplitude with which the residuals grow; 1 where it is not significant.
double growth_of(const Matrix& amplitudes, const Matrix& residuals) {
  const auto numbers = static_cast<double>(residuals.cols());
  MeanSum x, y, xx, xy;
  for (Eigen::Index i = 0; i < residuals.rows(); ++i) {
    const double square = residuals.row(i).squaredNorm() - numbers;
    if (!(square > kClearly * numbers)) continue;
    const double a = std::log(amplitudes.row(i).norm()), f = 0.5 * std::log(square);
    x.add(a), y.add(f), xx.add(a * a), xy.add(a * f);
  }
  const double spread = xx.mean() - x.mean() * x.mean();
  if (!(spread > kLeastScoreSpread)) return 1;
  return std::clamp((xy.mean() - x.mean() * y.mean()) / spread, 1.0, kMostGrowth);
}

// Share of the parameters' variance that calibration resolves: one less the ratio of the variance
// of its errors to that of the parameters.
Vector identifiable_share_by(const Matrix& points, const Matrix& off) {
  const auto variance = [](const Matrix& of) {
    return Vector((of.rowwise() - of.colwise().mean()).colwise().squaredNorm().transpose());
  };
  const Vector share = variance(off).cwiseQuotient(variance(points).cwiseMax(kLeastVariance));
  return (1 - share.array()).cwiseMax(0).matrix();
}

}  // namespace

// All effects in one loop: an effect has few experiments, and threads would wait for its last one.
void ReferenceEnsemble::learn_effects() {
  std::vector<Simulation> all;
  std::vector<Stages::RowsOfStage> wanted;
  std::uint64_t number = kEffectSeed;
  for (std::size_t e = 0; e < plan_.effects.size(); ++e) {
    all.push_back(learning(plan_.effects[e], derived_seed(options_.seed, number++)));
    wanted.push_back(scored("effect " + std::to_string(e), all.back()));
  }
  const auto rows = stages_.rows("experiments with each effect", wanted);
  for (std::size_t e = 0; e < all.size(); ++e) {
    fingerprints_.push_back(fingerprint(plan_.effects[e], responses(all[e], rows[e])));
  }
}

ReferenceEnsemble::Responses ReferenceEnsemble::answers(const Effect& effect,
                                                        const std::string& stage,
                                                        const Vector& about, const Matrix& spread,
                                                        const Matrix& amplitudes,
                                                        std::uint64_t seed) {
  const Simulation one = simulation_with(effect, about, spread, amplitudes, seed);
  const auto rows = stages_.rows("experiments with " + effect.name, {scored(stage, one)});
  return responses(one, rows.front());
}

ReferenceEnsemble::Responses ReferenceEnsemble::responses(
    const Simulation& of, const std::vector<std::vector<double>>& rows) const {
  const Design made = design_of(of.points, rows);
  const Eigen::Index parameters = centre_.size(), amplitudes = made.points.cols() - parameters;
  const Eigen::Index n = made.points.rows();
  Responses out{made.points.rightCols(amplitudes), made.points.leftCols(parameters),
                Matrix(n, deviation_.size()), Matrix(n, parameters)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vectors v{made.numbers.row(i).head(summary_numbers()),
                    made.numbers.row(i).tail(deviation_.size())};
    const Vector at = calibrated(v.summary);
    out.residuals.row(i) = residual_at(v.scores, at).transpose();
    out.moved.row(i) = at.transpose() - out.points.row(i);
  }
  return out;
}

ReferenceEnsemble::Simulation ReferenceEnsemble::learning(const Effect& effect,
                                                          std::uint64_t seed) const {
  const Matrix amplitudes = learning_amplitudes(effect, options_.learning.in_all(effect), seed);
  return simulation_with(effect, centre_, spread_, amplitudes, seed);
}

Fingerprint ReferenceEnsemble::fingerprint(const Effect& effect, const Responses& made) const {
  const auto m = static_cast<Eigen::Index>(effect.paths.size());
  Matrix x(made.amplitudes.rows(), 2 * m);
  x << made.amplitudes, made.amplitudes.array().square().matrix();
  // A ridge of the residuals' unit noise variance on the second-order terms, which are less
  // certain.
  Matrix normal = x.transpose() * x;
  for (Eigen::Index c = 0; c < m; ++c) normal(m + c, m + c) += kBend;
  const Matrix seen = solve_symmetric(normal, Matrix(x.transpose() * made.residuals));
  Matrix plain = made.amplitudes.transpose() * made.amplitudes;
  plain.diagonal().array() += kBend;
  const Matrix moved = solve_symmetric(plain, Matrix(made.amplitudes.transpose() * made.moved));
  Fingerprint out;
  out.about = Vector::Zero(m), out.base = Vector::Zero(deviation_.size());
  out.first = seen.topRows(m).transpose(), out.second = seen.bottomRows(m).transpose();
  out.moved_first = moved.transpose(), out.moved_base = Vector::Zero(centre_.size());
  out.identifiable_share = identifiable_share_by(made.points, made.moved - made.amplitudes * moved);
  out.experiments = options_.learning.of(effect), out.two_sided = effect.two_sided;
  out.low = effect.low, out.high = effect.high;
  out.growth = std::max(effect.growth, growth_of(made.amplitudes, made.residuals.leftCols(named_)));
  return out;
}

Vector ReferenceEnsemble::mean_residual(const Effect& effect, const Vector& amplitudes,
                                        const Vector& point, int experiments,
                                        const std::string& stage, std::uint64_t seed) {
  const Matrix at = amplitudes.transpose().replicate(experiments, 1);
  return answers(effect, stage, point, kNarrow * spread_, at, seed)
      .residuals.colwise()
      .mean()
      .transpose();
}

const Fingerprint& ReferenceEnsemble::shape_fingerprint(int s) {
  const auto known = shape_fingerprints_.find(s);
  if (known != shape_fingerprints_.end()) return known->second;
  const std::uint64_t seed =
      derived_seed(options_.curve_seed, kCurveSeed + static_cast<std::uint64_t>(s));
  const Effect effect = effect_of(plan_.shapes[static_cast<std::size_t>(s)]);
  const std::string stage = "shape " + std::to_string(s);
  const Simulation one = learning(effect, seed);
  const std::string& variable = plan_.shapes[static_cast<std::size_t>(s)].variable;
  const auto rows = stages_.rows("experiments with a law of " + variable, {scored(stage, one)});
  return shape_fingerprints_[s] = fingerprint(effect, responses(one, rows.front()));
}

Fingerprint ReferenceEnsemble::fingerprint_about(const Vector& estimate, const Fingerprint& from,
                                                 const Effect& effect, const Vector& calibrated,
                                                 const std::string& name,
                                                 LearnedFingerprints& learned, int experiments) {
  const Vector amplitudes = effect.within(estimate);
  const Eigen::Index m = amplitudes.size();
  const FitBounds bounds = stages_.bounds();
  // Parameters that a calibration does not identify beside the effect keep their prior mean.
  const Vector away =
      from.identifiable_share.cwiseProduct(calibrated - from.moved(amplitudes) - centre_);
  const Vector point = (centre_ + away).cwiseMax(bounds.low).cwiseMin(bounds.high);
  std::vector<LearnedFingerprint>& own = learned[name];
  if (const LearnedFingerprint* known = nearest_of(effect, own, amplitudes, point, experiments)) {
    return known->fingerprint;
  }
  // The key covers what is simulated, not the order of the calls.
  Fnv place;
  place.add(std::span(amplitudes.data(), static_cast<std::size_t>(m)));
  place.add(std::span(point.data(), static_cast<std::size_t>(point.size())));
  const std::uint64_t seed = derived_seed(derived_seed(options_.seed, kSharpSeed), place.value());
  std::string stage = "sharp " + name + " " + hex(place.value());
  if (experiments != kAbout) stage += " of " + std::to_string(experiments);
  const Responses made = answers(effect, stage, point, kNarrow * spread_,
                                 amplitudes_about(effect, amplitudes, experiments, seed), seed);
  // An affine response: the known secant slope, corrected in proportion to its noise.
  const Matrix off = made.amplitudes.rowwise() - amplitudes.transpose();
  const Matrix secant =
      from.first + from.second * (amplitudes - from.about).asDiagonal().toDenseMatrix();
  Matrix x(off.rows(), 1 + m);
  x << Vector::Ones(off.rows()), off;
  Matrix normal = x.transpose() * x;
  for (Eigen::Index c = 0; c < m; ++c) normal(1 + c, 1 + c) += kSlopeKnown;
  const Matrix solved =
      solve_symmetric(normal, Matrix(x.transpose() * (made.residuals - off * secant.transpose())));
  Fingerprint out = from;
  out.about = amplitudes, out.base = solved.row(0).transpose();
  out.first = secant + solved.bottomRows(m).transpose();
  out.second = Matrix::Zero(out.first.rows(), m);
  out.moved_base = made.moved.colwise().mean().transpose();
  out.identifiable_share = identifiable_share_by(made.points, made.moved);
  const auto n = static_cast<double>(off.rows());
  out.scatter = (made.residuals - off * secant.transpose() - x * solved) *
                std::sqrt(n / std::max(1.0, n - 1 - kSlopesFitted * static_cast<double>(m)));
  out.experiments = static_cast<int>(off.rows()), out.exact = 0;
  own.push_back({point, out, experiments});
  return out;
}

// The nearest fingerprint that covers these amplitudes and parameters; null if there is none.
const LearnedFingerprint* ReferenceEnsemble::nearest_of(
    const Effect& effect, const std::vector<LearnedFingerprint>& learned, const Vector& amplitudes,
    const Vector& point, int experiments) const {
  const LearnedFingerprint* nearest = nullptr;
  double least = 1;
  for (const LearnedFingerprint& one : learned) {
    if (one.experiments < experiments) continue;
    const Vector& at = one.fingerprint.about;
    const double far = (amplitudes - at).cwiseQuotient(apart(effect, at)).cwiseAbs().maxCoeff();
    const double off = solve_lower(spread_, point - one.point).cwiseAbs().maxCoeff();
    const double beyond = std::max(far / kBeside, off);
    if (beyond <= least) least = beyond, nearest = &one;
  }
  return nearest;
}

}  // namespace lilytank
