#include "finder/alignment.hpp"

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

Alignment::Alignment(const Atlas& atlas, const std::vector<Recording>& recordings)
    : atlas_(atlas), recordings_(recordings), scores_(atlas.informations().rows()) {
  const ScorePlan& plan = atlas.plan();
  own_ = score_informations(plan, recordings);
  Matrix alike = correlations_of(atlas.informations());
  alike.diagonal().array() += kUnalike;
  root_ = lower_root(alike), plain_ = lower_inverse(root_);
  for (std::size_t e = 0; e < plan.effects.size(); ++e) {
    const Effect& effect = plan.effects[e];
    if (!effect.scored) continue;
    told_[key_of(effect)] =
        from_informations(own_, static_cast<Eigen::Index>(plan.first_of_effect(e)),
                          static_cast<Eigen::Index>(effect.paths.size()));
  }
}

Matrix Alignment::from_informations(const Matrix& informations, Eigen::Index first,
                                    Eigen::Index count) const {
  Matrix out = informations.block(0, first, scores_, count);
  for (Eigen::Index k = 0; k < scores_; ++k) {
    out.row(k) /= (informations(k, k) + kScoreKnown) * atlas_.deviations()(k);
  }
  return out;
}

Vector Alignment::further_variance() const {
  const auto variance = [](const Matrix& informations) {
    const Eigen::ArrayXd own = informations.diagonal().array();
    return (own / (own + kScoreKnown).square()).eval();
  };
  const Eigen::ArrayXd more = variance(own_) - variance(atlas_.informations());
  Vector out = Vector::Zero(atlas_.named_numbers());
  out.head(scores_) = more.cwiseMax(0) / atlas_.deviations().head(scores_).array().square();
  return out;
}

const Matrix& Alignment::response(const Effect& effect) {
  const std::string key = key_of(effect);
  const auto known = told_.find(key);
  if (known != told_.end()) return known->second;
  const Matrix all = score_informations(atlas_.plan(), recordings_, {effect});
  return told_[key] =
             from_informations(all, scores_, static_cast<Eigen::Index>(effect.paths.size()));
}

// What is clear of scores once the correlations of their noise are taken out: with these in it,
// noise that is left out of one score would be found in another.
Vector Alignment::clear(const Vector& scores, double error) const {
  return root_ * (plain_ * scores).unaryExpr([&](double v) {
    return std::fabs(v) < kClearOfNoise * error ? 0.0 : v;
  });
}

// By which factor scores are what is expected of them.
double Alignment::factor(const Vector& scores, const Vector& expected) const {
  const Vector told = plain_ * expected;
  return (plain_ * scores).dot(told) / told.squaredNorm();
}

Fingerprint Alignment::aligned(Fingerprint of, const Effect& effect) {
  const Eigen::Index m = of.first.cols();
  const double n = std::max(1, of.experiments);
  const double error = 1 / std::sqrt((of.local() ? 1 : kLearnedSquare) * n);
  Matrix told = Matrix::Zero(scores_, m);
  if (effect.mean_force) told = response(effect);
  if (of.local()) {
    const Vector expected = told * of.about;
    double share = 0;
    if ((plain_ * expected).norm() > kLeastShown) {
      share = std::clamp(factor(of.base.head(scores_), expected), kLeastFactor, kMostFactor);
    }
    auto base = of.base.head(scores_);
    base = (share * expected + clear(base - share * expected, error)).eval();
    of.first.topRows(scores_) = share * told;
    of.second.topRows(scores_).setZero();
  } else {
    for (Eigen::Index c = 0; c < m; ++c) {
      auto first = of.first.col(c).head(scores_), second = of.second.col(c).head(scores_);
      double share = 0, bend = 0;
      if ((plain_ * told.col(c)).norm() > kLeastShown) {
        share = std::clamp(factor(first, told.col(c)), kLeastFactor, kMostFactor);
        bend = std::clamp(factor(second, told.col(c)), -share / 2, share / 2);
      }
      first = (share * told.col(c) + clear(first - share * told.col(c), error)).eval();
      second = (bend * told.col(c) + clear(second - bend * told.col(c), error)).eval();
    }
  }
  of.exact = scores_;
  return of;
}

}  // namespace lilytank
