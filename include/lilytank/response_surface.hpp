// A quadratic response surface of summary statistics over the parameters, and the parameters that
// it estimates from data.
//
// A regression over simulations at points scattered about a centre gives the mean of every
// statistic as a quadratic function of the parameters; its residuals give the covariance of the
// statistics in one experiment. Generalised least squares with both is indirect inference
// [Gourieroux, Monfort and Renault, J. Appl. Econometrics 8, 1993]. A fit needs no further
// simulation, so hundreds of data sets can be fitted.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace lilytank {

/// Simulations at scattered points: a row each.
struct Design {
  /// [simulation, parameter] On the scales that are fitted on.
  Eigen::MatrixXd points;
  Eigen::MatrixXd numbers;  ///< [simulation, number]
  /// [number, parameter] 1 where the mean of the number does not depend on the parameter; empty:
  /// every number may depend on every parameter.
  Eigen::MatrixXd independent = {};
};

/// Distance between the data's statistics and the surface's.
enum class Misfit {
  /// Squared distance by the inverse covariance (Mahalanobis).
  covariance,
  /// Sum of absolute differences, each with weight 1, as in Eq. 9.
  absolute,
};

/// Treatment of regression coefficients that may be noise.
enum class Slopes {
  /// Used as estimated. Noise in them biases fits towards the centre; inverse_regression()
  /// corrects the bias.
  found,
  /// Shrunk by their signal-to-noise ratio: for many statistics and few simulations.
  shrunk,
  /// Curvatures are shrunk by their signal-to-noise ratio, slopes are not: for statistics that are
  /// nearly linear in the parameters.
  straightened,
};

/// The region that a fit searches.
struct FitBounds {
  /// [parameters] Empty: bounded by `reach` alone.
  Eigen::VectorXd low, high;
  /// Largest distance from the centre of the design, in its standard deviations.
  double reach = 4;
};

/// The parameters of least misfit for one data set.
struct LocalFit {
  /// [parameters] On the scales that were fitted on.
  Eigen::VectorXd point;
  /// Value of the objective there.
  double misfit = 0;
  /// The fit stopped at FitBounds::reach: simulate a new design around it.
  bool at_bound = false;
};

/// Prior of the parameters: normal, without correlations.
struct Prior {
  /// [parameters] Mean and standard deviation; infinite deviation: no prior.
  Eigen::VectorXd expected, deviation;
};

/// The maximum a posteriori estimate.
struct MapEstimate {
  LocalFit fit;
  /// [parameters, parameters] Of the posterior, in its normal approximation.
  Eigen::MatrixXd covariance;
  /// Dispersion: mean square of the whitened residuals, at least 1. Where the surface does not
  /// explain the data, the likelihood is divided by it, and the prior gains weight.
  double dispersion = 1;
};

/// A quadratic response surface with the covariance of its residuals. Constant once made.
class ResponseSurface {
 public:
  /// Needs more simulations than coefficients: 1 + p + p (p + 1) / 2 for p parameters; with fewer
  /// than twice as many, products of different parameters are left out. Numbers that never vary do
  /// not count. Throws std::invalid_argument with too few.
  explicit ResponseSurface(const Design& design, Misfit misfit = Misfit::covariance,
                           Slopes slopes = Slopes::found);

  /// Moves the surface to the mean of experiments (a row of numbers each) simulated at `point`, and
  /// takes the scatter of these for the numbers' covariance: residuals of a design also hold what
  /// is not quadratic, most of it for numbers that the parameters change most.
  void anchor(const Eigen::VectorXd& point, const Eigen::MatrixXd& numbers);

  /// The mean of the numbers at a point.
  Eigen::VectorXd mean(const Eigen::VectorXd& point) const;
  /// Derivatives of the means, [number, parameter].
  Eigen::MatrixXd slope(const Eigen::VectorXd& point) const;
  /// Covariance of the statistics in one experiment: that of the residuals, its correlations shrunk
  /// towards 0 in proportion to their sampling error [Schaefer and Strimmer, Stat. Appl.
  /// Genet. Mol. Biol. 4, 2005].
  const Eigen::MatrixXd& covariance() const { return covariance_; }

  /// The parameters of least misfit to `numbers` [number].
  LocalFit fit(const Eigen::VectorXd& numbers, const FitBounds& bounds = {}) const;
  /// The maximum a posteriori under a normal prior.
  MapEstimate fit(const Eigen::VectorXd& numbers, const FitBounds& bounds,
                  const Prior& prior) const;
  /// fit() with one parameter held at a value: a point of its profile likelihood.
  LocalFit fit_with(const Eigen::VectorXd& numbers, int parameter, double value,
                    const FitBounds& bounds = {}) const;
  /// The objective of fit(): squared Mahalanobis distance, or the sum of absolute differences.
  double misfit(const Eigen::VectorXd& numbers, const Eigen::VectorXd& point) const;
  /// Covariance of fitted parameters to first order, from the covariance of the numbers.
  Eigen::MatrixXd parameter_covariance(const Eigen::VectorXd& point) const;
  /// The same with a normal prior of deviations `prior` [parameters]: never wider than the prior.
  Eigen::MatrixXd parameter_covariance(const Eigen::VectorXd& point,
                                       const Eigen::VectorXd& prior) const;

 private:
  struct Problem;
  Eigen::VectorXd standard(const Eigen::VectorXd& point) const;
  Eigen::VectorXd basis(const Eigen::VectorXd& z) const;
  Eigen::MatrixXd basis_slope(const Eigen::VectorXd& z) const;
  LocalFit solve(const Eigen::VectorXd& numbers, int held, double value, const FitBounds& bounds,
                 const Prior& prior) const;
  void clear(const Eigen::MatrixXd& independent);
  void shrink(const Eigen::VectorXd& errors, Eigen::Index from);
  void find_covariance(const Eigen::MatrixXd& residuals, double freedom);

  Misfit kind_;
  bool products_ = true;
  Eigen::VectorXd centre_;
  /// Point = centre + unit z, z of unit covariance.
  Eigen::MatrixXd unit_, to_unit_;
  Eigen::MatrixXd coefficients_;  ///< [number, basis]
  Eigen::MatrixXd covariance_;
  /// Maps numbers so that their covariance becomes 1.
  Eigen::MatrixXd whitener_;
};

}  // namespace lilytank
