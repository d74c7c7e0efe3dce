// The gusts' strength as a smooth field: how much it varies over the tank is weighed by how well
// that explains the data.
#pragma once
#include <Eigen/Core>

namespace lilytank {

/// Mean and covariance of the coefficients of smooth functions.
struct GustPosterior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};
/// Combines what the data say, a quadratic form with this information about the coefficients and
/// its product with their best values, with the prior: a constant is 0 with standard deviation 1
/// (of log s^2), and each coefficient differs from it by an unknown standard deviation, one for the
/// first `plane` coefficients, another for the others. Both are averaged over with the weights of
/// their marginal likelihoods [MacKay, Neural Computation 4, 1992].
GustPosterior gust_posterior(const Eigen::MatrixXd& information, const Eigen::VectorXd& product,
                             Eigen::Index plane);

}  // namespace lilytank
