#include "flow/gust_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace lilytank {
namespace {

struct Candidate {
  double variation, evidence;
  GustPosterior fit;
};

Candidate fit_with(double variation, const Eigen::MatrixXd& information,
                   const Eigen::VectorXd& product) {
  const Eigen::Index n = product.size();
  // Prior covariance C = variation^2 I + 1 1^T; posterior (C^-1 + S)^-1 = C - C (C + S^-1)^-1 C
  // without inverting S: with C = R R^T it is R (I + R^T S R)^-1 R^T.
  Eigen::MatrixXd prior = Eigen::MatrixXd::Ones(n, n);
  prior.diagonal().array() += variation * variation + 1e-9;
  const Eigen::MatrixXd root = prior.llt().matrixL();
  Eigen::MatrixXd inner = root.transpose() * information * root;
  inner.diagonal().array() += 1;
  const Eigen::LLT<Eigen::MatrixXd> factor(inner);
  Candidate out;
  out.variation = variation;
  const Eigen::VectorXd right = root.transpose() * product;
  out.fit.mean = root * factor.solve(right);
  out.fit.covariance = root * factor.solve(root.transpose());
  const Eigen::VectorXd pivots = factor.matrixLLT().diagonal();
  out.evidence = 0.5 * right.dot(factor.solve(right)) - pivots.array().log().sum();
  return out;
}

}  // namespace

GustPosterior gust_posterior(const Eigen::MatrixXd& information, const Eigen::VectorXd& product) {
  constexpr double kVariations[] = {0.02, 0.1, 0.2, 0.3, 0.45, 0.65, 0.9, 1.3};
  std::vector<Candidate> all;
  double best = 0;
  for (const double v : kVariations) {
    all.push_back(fit_with(v, information, product));
    if (all.size() == 1 || all.back().evidence > best) best = all.back().evidence;
  }
  double total = 0;
  for (const Candidate& c : all) total += std::exp(c.evidence - best);
  GustPosterior out;
  out.mean = Eigen::VectorXd::Zero(product.size());
  out.covariance = Eigen::MatrixXd::Zero(product.size(), product.size());
  for (const Candidate& c : all) out.mean += std::exp(c.evidence - best) / total * c.fit.mean;
  for (const Candidate& c : all) {
    const double weight = std::exp(c.evidence - best) / total;
    const Eigen::VectorXd apart = c.fit.mean - out.mean;
    out.covariance += weight * (c.fit.covariance + apart * apart.transpose());
    if (c.evidence == best) out.variation = c.variation;
  }
  return out;
}

}  // namespace lilytank
