// Cross-fitted response surfaces: estimates of simulations that the surface was not fitted to,
// which have the same errors as estimates from data.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calibrate/estimate_line.hpp"
#include "lilytank/response_surface.hpp"

namespace lilytank {

/// Estimates for every simulation of a design, each from a surface fitted without it, and for the
/// data from all these surfaces.
struct CrossFit {
  Eigen::MatrixXd estimates;  ///< [simulation, parameter]
  Eigen::VectorXd misfits;    ///< [simulation]
  Eigen::VectorXd answer;     ///< of data, the mean over the models
  double misfit = 0;          ///< of data, likewise
  std::vector<ResponseSurface> models;
  /// The mean estimate and the mean misfit over the surfaces for other numbers.
  LocalFit of(const Eigen::VectorXd& numbers) const;
};

/// By eight models, each without every eighth simulation. Throws std::invalid_argument where these
/// are too few.
CrossFit cross_fit(const Design& design, const Eigen::VectorXd& data, Misfit misfit, Slopes slopes);

/// The data's estimate, corrected for bias. Noise in a surface's slopes draws estimates to the
/// centre: a hundred statistics that do not depend on a parameter seem to. The regression of the
/// simulations' estimates on their true parameters measures this bias; its inverse removes it.
struct BiasCorrectedFit {
  Eigen::VectorXd point;
  Eigen::MatrixXd covariance;  ///< of an answer's error
  Eigen::MatrixXd errors;      ///< of the design's simulations, a row each
  double wide = 0;             ///< half width of a 95 % interval, in deviations
};
/// `least`: floor of the regression's slope (1: no bias); below it a direction is not identifiable
/// and its inverse would diverge.
BiasCorrectedFit bias_corrected(const Design& design, const CrossFit& fit, double least);

/// The same by the posterior under a prior: a direction that is not identifiable keeps the prior's.
BiasCorrectedFit bias_corrected(const Design& design, const CrossFit& fit, const Prior& prior);

/// Bias correction with a prior: the cross-fitted estimates are regressed on the true parameters,
/// and the inverse of this line at the data's estimate is combined with the prior.
struct InverseRegression {
  CrossFit by_others;
  Line line;
  ParameterEstimate answer;
};
/// `centre`: of the line. Throws as cross_fit.
InverseRegression inverse_regression(const Design& design, const Eigen::VectorXd& centre,
                                     const Prior& prior, const Eigen::VectorXd& data);
/// The same surfaces, each anchored (ResponseSurface::anchor) to `experiments` (a row of numbers
/// each) that were simulated at `point`, but for every eighth of them. The scatter of estimates is
/// that of these experiments, each estimated by the surface without it; the line passes through
/// `point`, with the slope of estimates of the design's simulations.
InverseRegression anchored(const InverseRegression& about, const Design& design,
                           const Eigen::VectorXd& point, const Eigen::MatrixXd& experiments,
                           const Prior& prior, const Eigen::VectorXd& data);

}  // namespace lilytank
