// Regression of estimates on the true parameters of simulated experiments, and its inverse: the
// posterior of the data's parameters.
#pragma once
#include <Eigen/Core>

#include "lilytank/response_surface.hpp"

namespace lilytank {

/// Linear regression of values on the parameters about a centre, with its residuals.
struct Line {
  Eigen::VectorXd at_centre;
  Eigen::MatrixXd slope;       ///< [value, parameter]
  Eigen::MatrixXd residuals;   ///< [simulation, value]
  Eigen::MatrixXd covariance;  ///< of a simulation's residuals
  Eigen::MatrixXd inverse;     ///< of the regressors' squares and products
  double freedom = 1;
};
/// `off`: the points less the centre, a row each; all zero: the values' mean alone. `values`: a row
/// a point.
Line line_through(const Eigen::MatrixXd& off, const Eigen::MatrixXd& values);

/// Bias-corrected parameters of the data.
struct ParameterEstimate {
  Eigen::VectorXd estimate, deviation;
  Eigen::MatrixXd correlation, back;
  double wide = 0;  ///< half width of a 95 % interval in deviations
};
/// Posterior of the parameters for the surface's estimate `answer`, by the regression `line` about
/// `centre` and the prior. A parameter on which the estimates hardly depend keeps its prior mean;
/// no interval is wider than the prior's.
ParameterEstimate estimate_of(const Line& line, const Eigen::VectorXd& centre,
                              const Eigen::VectorXd& answer, const Prior& prior);

}  // namespace lilytank
