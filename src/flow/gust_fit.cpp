#include "flow/gust_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace lilytank {
namespace {

struct Candidate {
  double evidence = 0;
  GustPosterior fit;
};

// `spread`: prior standard deviation of each coefficient about the common constant.
Candidate fit_with(const Eigen::VectorXd& spread, Eigen::Index plane,
                   const Eigen::MatrixXd& information, const Eigen::VectorXd& product) {
  // Prior covariance C = spread^2 + 1 1^T, the constant made of the first functions, which sum to
  // 1. The posterior (C^-1 + S)^-1 is R (I + R^T S R)^-1 R^T with C = R R^T: S need not be regular.
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(product.size(), product.size());
  prior.topLeftCorner(plane, plane).setOnes();
  prior.diagonal() += spread.cwiseAbs2();
  const Eigen::MatrixXd root = prior.llt().matrixL();
  Eigen::MatrixXd inner = root.transpose() * information * root;
  inner.diagonal().array() += 1;
  const Eigen::LLT<Eigen::MatrixXd> factor(inner);
  Candidate out;
  if (factor.info() != Eigen::Success) {
    // The data speak against any strength at all: nothing is learned from them.
    out.fit = {Eigen::VectorXd::Zero(product.size()), prior};
    out.evidence = -1e300;
    return out;
  }
  const Eigen::VectorXd right = root.transpose() * product;
  out.fit.mean = root * factor.solve(right);
  out.fit.covariance = root * factor.solve(root.transpose());
  const Eigen::VectorXd pivots = factor.matrixLLT().diagonal();
  out.evidence = 0.5 * right.dot(factor.solve(right)) - pivots.array().log().sum();
  return out;
}

}  // namespace

GustPosterior gust_posterior(const Eigen::MatrixXd& information, const Eigen::VectorXd& product,
                             Eigen::Index plane) {
  constexpr double kSpreads[] = {0.02, 0.15, 0.3, 0.5, 0.9};
  const Eigen::Index n = product.size();
  std::vector<Candidate> all;
  double best = 0;
  for (const double first : kSpreads) {
    for (const double others : kSpreads) {
      Eigen::VectorXd spread = Eigen::VectorXd::Constant(n, others);
      spread.head(plane).setConstant(first);
      all.push_back(fit_with(spread, plane, information, product));
      if (all.size() == 1 || all.back().evidence > best) best = all.back().evidence;
      if (plane == n) break;
    }
  }
  double total = 0;
  for (const Candidate& c : all) total += std::exp(c.evidence - best);
  GustPosterior out;
  out.mean = Eigen::VectorXd::Zero(n);
  out.covariance = Eigen::MatrixXd::Zero(n, n);
  for (const Candidate& c : all) out.mean += std::exp(c.evidence - best) / total * c.fit.mean;
  for (const Candidate& c : all) {
    const double weight = std::exp(c.evidence - best) / total;
    const Eigen::VectorXd apart = c.fit.mean - out.mean;
    out.covariance += weight * (c.fit.covariance + apart * apart.transpose());
  }
  return out;
}

}  // namespace lilytank
