// Response of the statistics to the amplitudes of an effect, and the fit of amplitudes to data.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <vector>

namespace lilytank {

/// base + first d + second d^2, d = amplitudes - about. About 0 the base is 0.
struct ResponseModel {
  Eigen::VectorXd about;          ///< [amplitude], in units of the effect's sizes
  Eigen::VectorXd base;           ///< [number]
  Eigen::MatrixXd first, second;  ///< [number, amplitude]
  bool two_sided = false;         ///< amplitudes may be negative
  /// Beyond these, amplitudes leave the bounds of a parameter.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  /// About amplitudes that were found.
  bool local() const { return about.cwiseAbs().maxCoeff() > 0; }
  Eigen::VectorXd at(const Eigen::VectorXd& amplitudes) const;
  /// Change of every number by each amplitude, [number, amplitude].
  Eigen::MatrixXd slope(const Eigen::VectorXd& amplitudes) const;
  /// Bounds of the amplitudes: 0 for those that cannot be negative; close to `about` where that is
  /// not 0.
  Eigen::VectorXd least() const;
  Eigen::VectorXd most() const;
  bool at_bound(const Eigen::VectorXd& amplitudes) const;
  /// The first of the numbers.
  ResponseModel top(Eigen::Index numbers) const;
};

/// Amplitudes of all models in order, and the residuals of the data.
struct ResponseFit {
  Eigen::VectorXd amplitudes, left;
};

/// Least squares [Gauss and Newton] from `start` by models that add up, within their bounds.
ResponseFit fit_responses(const std::vector<const ResponseModel*>& answers,
                          const Eigen::VectorXd& data, const Eigen::VectorXd& start);
/// The same by one model, from within its bounds; amplitudes of 0 if the fit does not reduce the
/// residuals.
ResponseFit fit_response(const ResponseModel& answer, const Eigen::VectorXd& data);

}  // namespace lilytank
