// Residuals in units of their scatter in null experiments.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace lilytank {

/// Covariances of residuals in null experiments and what whitens by them. A residual holds the
/// named statistics first, then the knots of every curve; curves overlap, so each is whitened by
/// itself.
struct Whitening {
  Eigen::Index named = 0;         ///< statistics before the curves' knots
  Eigen::MatrixXd expected_root;  ///< lower root of the expected correlations, [named, named]
  Eigen::VectorXd centre;         ///< mean of null residuals
  /// Variance up to 1 that named statistics do not show among all nulls: of rare places.
  Eigen::VectorXd missing;
  Eigen::MatrixXd covariance;                    ///< of the named statistics of nulls
  std::vector<Eigen::MatrixXd> knot_covariance;  ///< of every curve
  Eigen::MatrixXd whitener;                      ///< of the named statistics
  std::vector<Eigen::MatrixXd> knot_whitener;    ///< of every curve

  std::size_t curves() const { return knot_whitener.size(); }
  Eigen::Index first_knot(std::size_t curve) const;
  /// Columns of residuals (or of their derivatives), the named statistics and each curve's knots
  /// each by their covariance.
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& residuals) const;
  /// An observed residual about the nulls' mean, whitened.
  Eigen::VectorXd of(const Eigen::VectorXd& residual) const;
  /// Squared distance of the named statistics from the nulls' mean.
  double misfit(const Eigen::VectorXd& residual) const;
  /// Whitener of the named statistics by the scatter of experiments, a row each about their mean,
  /// where that is more than the nulls'. Of too few experiments: by the nulls' covariance.
  Eigen::MatrixXd whitener_by(const Eigen::MatrixXd& scatter) const;
};

/// `nulls`: a row each; `expected_correlation`: of the first statistics (score_correlations), or
/// empty; `curves`: times kKnots columns at the end are knots.
Whitening whitening_by_nulls(const Eigen::MatrixXd& nulls,
                             const Eigen::MatrixXd& expected_correlation, std::size_t curves);
/// The same whitening, but of the named statistics by these nulls alone.
Whitening with_nulls(Whitening whitening, const Eigen::MatrixXd& nulls);
/// The named statistics have so much more variance.
Whitening with_variance(Whitening whitening, const Eigen::VectorXd& variance);
/// By the scatter of experiments, a row each about their mean, where that is more than the nulls':
/// modules that stick scatter otherwise than modules that drift. Unchanged for too few experiments.
Whitening with_scatter(Whitening whitening, const Eigen::MatrixXd& scatter);

}  // namespace lilytank
