#include "finder/score_sensitivity.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/linear.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kClearOfNoise = 3;  // standard errors of what simulations say beside the filter
constexpr double kLeastShown = 2;    // deviations at an amplitude of one
constexpr double kLeastFactor = 0.2, kMostFactor = 2;  // of the filter's answer, that is believed

std::string key_of(const Effect& effect) {
  std::string key = effect.name;
  for (const std::string& path : effect.paths) key += " " + path;
  for (const auto& [of, value] : effect.held) key += " " + of.path() + " " + shortest(value);
  return key;
}

}  // namespace

ScoreSensitivity::ScoreSensitivity(const ReferenceEnsemble& ensemble,
                                   const std::vector<Recording>& recordings)
    : ensemble_(ensemble), recordings_(recordings), scores_(ensemble.informations().rows()) {
  const ScorePlan& plan = ensemble.plan();
  own_ = score_informations(plan, recordings);
  Matrix alike = correlations_of(ensemble.informations());
  alike.diagonal().array() += kUniqueVariance;
  root_ = lower_root(alike), plain_ = lower_inverse(root_);
  for (std::size_t e = 0; e < plan.effects.size(); ++e) {
    const Effect& effect = plan.effects[e];
    if (!effect.scored) continue;
    responses_[key_of(effect)] =
        from_informations(own_, static_cast<Eigen::Index>(plan.first_of_effect(e)),
                          static_cast<Eigen::Index>(effect.paths.size()));
  }
}

Matrix ScoreSensitivity::from_informations(const Matrix& informations, Eigen::Index first,
                                           Eigen::Index count) const {
  Matrix out = informations.block(0, first, scores_, count);
  for (Eigen::Index k = 0; k < scores_; ++k) {
    out.row(k) /= (informations(k, k) + kScoreKnown) * ensemble_.deviations()(k);
  }
  return out;
}

Vector ScoreSensitivity::further_variance() const {
  const auto variance = [](const Matrix& informations) {
    const Eigen::ArrayXd own = informations.diagonal().array();
    return (own / (own + kScoreKnown).square()).eval();
  };
  const Eigen::ArrayXd more = variance(own_) - variance(ensemble_.informations());
  Vector out = Vector::Zero(ensemble_.named_numbers());
  out.head(scores_) = more.cwiseMax(0) / ensemble_.deviations().head(scores_).array().square();
  return out;
}

const Matrix& ScoreSensitivity::response(const Effect& effect) {
  const std::string key = key_of(effect);
  const auto known = responses_.find(key);
  if (known != responses_.end()) return known->second;
  const Matrix all = score_informations(ensemble_.plan(), recordings_, {effect});
  return responses_[key] =
             from_informations(all, scores_, static_cast<Eigen::Index>(effect.paths.size()));
}

// Significant part of decorrelated scores: with correlated noise, noise removed from one score
// would appear in another.
Vector ScoreSensitivity::clear(const Vector& scores, double error) const {
  return root_ * (plain_ * scores).unaryExpr([&](double v) {
    return std::fabs(v) < kClearOfNoise * error ? 0.0 : v;
  });
}

// Least-squares factor between scores and their expectation.
double ScoreSensitivity::factor(const Vector& scores, const Vector& expected) const {
  const Vector expected_response = plain_ * expected;
  return (plain_ * scores).dot(expected_response) / expected_response.squaredNorm();
}

Fingerprint ScoreSensitivity::aligned(Fingerprint of, const Effect& effect) {
  const Eigen::Index m = of.first.cols();
  const double n = std::max(1, of.experiments);
  const double error = 1 / std::sqrt((of.local() ? 1 : kLearnedSquare) * n);
  Matrix expected_response = Matrix::Zero(scores_, m);
  if (effect.mean_force) expected_response = response(effect);
  if (of.local()) {
    const Vector expected = expected_response * of.about;
    double share = 0;
    if ((plain_ * expected).norm() > kLeastShown) {
      share = std::clamp(factor(of.base.head(scores_), expected), kLeastFactor, kMostFactor);
    }
    auto base = of.base.head(scores_);
    base = (share * expected + clear(base - share * expected, error)).eval();
    of.first.topRows(scores_) = share * expected_response;
    of.second.topRows(scores_).setZero();
  } else {
    for (Eigen::Index c = 0; c < m; ++c) {
      auto first = of.first.col(c).head(scores_), second = of.second.col(c).head(scores_);
      double share = 0, bend = 0;
      if ((plain_ * expected_response.col(c)).norm() > kLeastShown) {
        share = std::clamp(factor(first, expected_response.col(c)), kLeastFactor, kMostFactor);
        bend = std::clamp(factor(second, expected_response.col(c)), -share / 2, share / 2);
      }
      first = (share * expected_response.col(c) +
               clear(first - share * expected_response.col(c), error))
                  .eval();
      second =
          (bend * expected_response.col(c) + clear(second - bend * expected_response.col(c), error))
              .eval();
    }
  }
  of.exact = scores_;
  return of;
}

}  // namespace lilytank
