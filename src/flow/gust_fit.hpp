// The gusts' strength as a smooth field: how much it varies over the tank is weighed by how well
// that explains the data.
#pragma once
#include <Eigen/Core>

namespace lilytank {

/// Mean and covariance of the coefficients of smooth functions, and their deviation `variation`
/// that is most likely.
struct GustPosterior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  double variation = 0;
};
/// Combines what the data say, a quadratic form with this information about the coefficients and
/// its product with their best values, with what is known before: all coefficients together are 0
/// with deviation 1 (of log s^2), and each differs from that by an unknown deviation, which is
/// averaged over with the weights of its marginal likelihoods [MacKay, Neural Computation 4, 1992].
GustPosterior gust_posterior(const Eigen::MatrixXd& information, const Eigen::VectorXd& product);

}  // namespace lilytank
