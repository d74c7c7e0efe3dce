#include "finder/null_thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibrate/design.hpp"
#include "forces/empirical_force.hpp"
#include "lilytank/math.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kNullFolds = 20;
// Shares of the false positives; with kOfPlaces they sum to 1.
constexpr double kOfEffect = 0.5, kOfShape = 0.2, kOfMisfit = 0.2;
// The share of an effect beside others, where what remains is more than noise: errors of the
// others' fingerprints.
constexpr double kOfFurther = 0.05;
constexpr double kEulerGamma = 0.57721566490153286;

// Gains of one candidate in one null.
struct Gains {
  double named = 0, all = 0;
};

struct NullGains {
  std::vector<std::vector<Gains>> candidates;  // [candidate][null]
  Matrix knots;                                // a row each null, a column each curve
  std::vector<double> misfits;                 // squared distance of the named statistics
};

NullGains gains_of_nulls(const Matrix& nulls, const Whitening& whitening,
                         const std::vector<EffectCandidate>& candidates) {
  const Eigen::Index n = nulls.rows();
  NullGains out;
  out.candidates.resize(candidates.size());
  out.knots.resize(n, static_cast<Eigen::Index>(whitening.curves()));
  for (int fold = 0; fold < kNullFolds; ++fold) {
    const Whitening others = with_nulls(whitening, rows_without_fold(nulls, fold, kNullFolds));
    std::vector<EffectCandidate> by_others;
    for (const EffectCandidate& c : candidates) by_others.push_back(renewed(c, others, c.source));
    for (Eigen::Index i = fold; i < n; i += kNullFolds) {
      const Vector all = others.of(nulls.row(i).transpose());
      out.misfits.push_back(all.head(others.named).squaredNorm());
      for (std::size_t k = 0; k < by_others.size(); ++k) {
        const EffectCandidate& c = by_others[k];
        out.candidates[k].push_back(
            {fitted(c, c.named, all.head(others.named)).gain, fitted(c, c.all, all).gain});
      }
      for (std::size_t s = 0; s < others.curves(); ++s) {
        out.knots(i, static_cast<Eigen::Index>(s)) =
            all.segment(others.first_knot(s), kKnots).squaredNorm();
      }
    }
  }
  return out;
}

// The scales of a candidate's gains; raises the largest z of every null to this candidate's.
void calibrate_candidate(const EffectCandidate& of, const std::vector<Gains>& gains,
                         std::vector<double>& largest, NullCalibration& out) {
  const auto n = static_cast<double>(gains.size());
  Gains mean;
  for (const Gains& g : gains) mean.named += g.named / n, mean.all += g.all / n;
  const Eigen::Index m = of.named.first.cols();
  // An amplitude that cannot be negative is 0 in half of the nulls.
  const double freedom = static_cast<double>(m) * (of.named.two_sided ? 1 : 0.5);
  const double scale = std::max(kLeastScale, mean.named / freedom);
  const double scale_all = std::max(kLeastScale, mean.all / freedom);
  for (std::size_t i = 0; i < gains.size(); ++i) {
    largest[i] = std::max(
        {largest[i], z_of_gain(gains[i].named, scale, m), z_of_gain(gains[i].all, scale_all, m)});
  }
  out.scale.push_back(scale), out.scale_all.push_back(scale_all);
}

}  // namespace

ExtremeLaw::ExtremeLaw(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double square = 0;
  for (const double v : values) mean_ += v / n;
  for (const double v : values) square += (v - mean_) * (v - mean_) / (n - 1);
  scale_ = std::sqrt(6 * square) / kPi;
}

double ExtremeLaw::exceeded_with(double probability) const {
  return mean_ + scale_ * (-std::log(-std::log(1 - probability)) - kEulerGamma);
}

double ExtremeLaw::chance_beyond(double value) const {
  if (!(scale_ > 0)) return value < mean_ ? 1 : 0;
  return -std::expm1(-std::exp(-((value - mean_) / scale_ + kEulerGamma)));
}

NullCalibration calibrate_on_nulls(const Matrix& nulls, const Whitening& whitening,
                                   const std::vector<EffectCandidate>& candidates,
                                   double false_alarms) {
  const NullGains gains = gains_of_nulls(nulls, whitening, candidates);
  NullCalibration out;
  std::vector<double> largest_effect(static_cast<std::size_t>(nulls.rows()));
  std::vector<double> largest_shape = largest_effect;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    calibrate_candidate(candidates[k], gains.candidates[k], largest_effect, out);
  }
  for (Eigen::Index s = 0; s < gains.knots.cols(); ++s) {
    const auto of = gains.knots.col(s);
    const double scale = std::max(kLeastScale, of.mean() / kKnots);
    for (std::size_t i = 0; i < largest_shape.size(); ++i) {
      const double z = z_of_gain(of(static_cast<Eigen::Index>(i)), scale, kKnots);
      largest_shape[i] = std::max(largest_shape[i], z);
    }
    out.shape_scale.push_back(scale);
  }
  NullThresholds& t = out.thresholds;
  t.largest_effect = ExtremeLaw(largest_effect), t.largest_shape = ExtremeLaw(largest_shape);
  t.effect = t.largest_effect.exceeded_with(kOfEffect * false_alarms);
  t.further = t.largest_effect.exceeded_with(kOfFurther * false_alarms);
  t.shape = t.largest_shape.exceeded_with(kOfShape * false_alarms);
  t.misfit = ExtremeLaw(gains.misfits).exceeded_with(kOfMisfit * false_alarms);
  t.mean_misfit = std::accumulate(gains.misfits.begin(), gains.misfits.end(), 0.0) /
                  static_cast<double>(nulls.rows());
  return out;
}

}  // namespace lilytank
