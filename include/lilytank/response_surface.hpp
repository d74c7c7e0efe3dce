// How numbers that a simulation tells depend on its parameters near one point, and what data then
// say of the parameters.
//
// Simulations at points scattered about the centre give, by regression, the mean of every number as
// a quadratic function of the parameters, and from what remains the covariance of the numbers in
// one experiment. Generalised least squares with these two is indirect inference [Gourieroux,
// Monfort and Renault, J. Appl. Econometrics 8, 1993]: the parameters whose simulated numbers are
// most like those of the data. It needs no further simulation, so it can be asked for hundreds of
// data sets.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace lilytank {

/// Simulations at scattered points: a row each.
struct Design {
  /// [simulation, parameter] On the scales that are fitted on.
  Eigen::MatrixXd points;
  Eigen::MatrixXd numbers;  ///< [simulation, number]
};

/// How far data are from a model's numbers.
enum class Misfit {
  /// Squared distance by the inverse covariance (Mahalanobis).
  covariance,
  /// Sum of sizes, every number alike, as in Eq. 9.
  absolute,
};

/// What is taken of coefficients that may be noise.
enum class Slopes {
  /// All of it: answers are then held to the centre, which line_through() makes good.
  found,
  /// Less the less they exceed their errors: where numbers are many and simulations few.
  shrunk,
};

/// Where to look for parameters.
struct FitBounds {
  /// Empty: nowhere but within reach of the design.
  Eigen::VectorXd low, high;
  /// Largest distance from the centre of the design, in its standard deviations.
  double reach = 4;
};

/// The best parameters for one set of data.
struct LocalFit {
  /// [parameters] On the scales that were fitted on.
  Eigen::VectorXd point;
  /// Value of the objective there.
  double misfit = 0;
  /// The fit stopped at FitBounds::reach: simulate a new design around it.
  bool at_reach = false;
};

/// What is known of parameters before data speak: a normal law without correlations.
struct Prior {
  /// [parameters] Mean and standard deviation; infinite deviation: no prior.
  Eigen::VectorXd expected, deviation;
};

/// The parameters that data and prior ask for together.
struct KnownFit {
  LocalFit fit;
  /// [parameters, parameters] Of the posterior, in its normal approximation.
  Eigen::MatrixXd covariance;
  /// Mean square of what remains, at least 1: where the model does not explain the data, these
  /// count for that much less, and what was known before for that much more.
  double doubt = 1;
};

/// A quadratic response surface with the covariance of its residuals. Constant once made.
class LocalModel {
 public:
  /// Needs more simulations than coefficients: 1 + p + p (p + 1) / 2 for p parameters; with fewer
  /// than twice as many, products of different parameters are left out. Numbers that never vary do
  /// not count. Throws std::invalid_argument with too few.
  explicit LocalModel(const Design& design, Misfit misfit = Misfit::covariance,
                      Slopes slopes = Slopes::found);

  /// The mean of the numbers at a point.
  Eigen::VectorXd mean(const Eigen::VectorXd& point) const;
  /// Derivatives of the means, [number, parameter].
  Eigen::MatrixXd slope(const Eigen::VectorXd& point) const;
  /// Covariance of the statistics in one experiment: that of the residuals, its correlations shrunk
  /// towards 0 by as much as their sampling error asks for [Schaefer and Strimmer, Stat. Appl.
  /// Genet. Mol. Biol. 4, 2005].
  const Eigen::MatrixXd& covariance() const { return covariance_; }

  /// The parameters whose numbers are nearest to those of data.
  LocalFit fit(const Eigen::VectorXd& numbers, const FitBounds& bounds = {}) const;
  /// The maximum a posteriori under a normal prior.
  KnownFit fit(const Eigen::VectorXd& numbers, const FitBounds& bounds, const Prior& prior) const;
  /// fit() with one parameter held at a value: a point of its profile likelihood.
  LocalFit fit_with(const Eigen::VectorXd& numbers, int parameter, double value,
                    const FitBounds& bounds = {}) const;
  /// The objective of fit(): squared Mahalanobis distance, or the sum of absolute differences.
  double misfit(const Eigen::VectorXd& numbers, const Eigen::VectorXd& point) const;
  /// Covariance of fitted parameters to first order, from the covariance of the numbers.
  Eigen::MatrixXd parameter_covariance(const Eigen::VectorXd& point) const;
  /// The same of parameters that were known before, to `prior` (deviations): never wider.
  Eigen::MatrixXd parameter_covariance(const Eigen::VectorXd& point,
                                       const Eigen::VectorXd& prior) const;

 private:
  struct Problem;
  Eigen::VectorXd standard(const Eigen::VectorXd& point) const;
  Eigen::VectorXd basis(const Eigen::VectorXd& z) const;
  Eigen::MatrixXd basis_slope(const Eigen::VectorXd& z) const;
  LocalFit solve(const Eigen::VectorXd& numbers, int held, double value, const FitBounds& bounds,
                 const Prior& prior) const;
  void shrink(const Eigen::VectorXd& errors);
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
