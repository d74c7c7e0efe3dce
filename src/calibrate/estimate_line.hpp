// Estimates of experiments whose parameters are known, as a line in these, and its inverse: what
// data's estimate says of their parameters, and how surely.
#pragma once
#include <Eigen/Core>

#include "lilytank/response_surface.hpp"

namespace lilytank {

/// How values depend on the parameters about a centre: a line, and what scatters about it.
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

/// Parameters of data from what the local model takes them for.
struct Scatter {
  Eigen::VectorXd estimate, deviation;
  Eigen::MatrixXd correlation, back;
  double wide = 0;  ///< half width of a 95 % interval in deviations
};
/// The local model's slopes carry noise, which draws its answers to its centre. Experiments of
/// known parameters tell by how much: `line` is through their answers, and this is what `answer`
/// then says together with what is known of the parameters before: what answers hardly tell stays
/// as it was expected, and its interval is no wider than that. `centre`: of the line.
Scatter scatter_of(const Line& line, const Eigen::VectorXd& centre, const Eigen::VectorXd& answer,
                   const Prior& prior);

}  // namespace lilytank
