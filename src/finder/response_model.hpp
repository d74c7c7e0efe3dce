// How numbers answer to the amplitudes of an effect, and amplitudes that are fitted to numbers.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace lilytank {

/// base + first d + second d^2, d = amplitudes - about. About 0 the base is nothing.
struct ResponseModel {
  Eigen::VectorXd about;          ///< [amplitude], in units of the effect's sizes
  Eigen::VectorXd base;           ///< [number]
  Eigen::MatrixXd first, second;  ///< [number, amplitude]
  bool two_sided = false;         ///< amplitudes may be negative
  /// About amplitudes that were found.
  bool local() const { return about.cwiseAbs().maxCoeff() > 0; }
  Eigen::VectorXd at(const Eigen::VectorXd& amplitudes) const;
  /// Change of every number by each amplitude, [number, amplitude].
  Eigen::MatrixXd slope(const Eigen::VectorXd& amplitudes) const;
  /// How far amplitudes may go: those that cannot be negative stop at nothing, those about found
  /// ones stay near them.
  Eigen::VectorXd least() const;
  Eigen::VectorXd most() const;
  bool at_reach(const Eigen::VectorXd& amplitudes) const;
  /// The first of the numbers.
  ResponseModel top(Eigen::Index numbers) const;
};

/// Amplitudes, one answer's after the other's, and what they leave of the data.
struct ResponseFit {
  Eigen::VectorXd amplitudes, left;
};

/// Least squares [Gauss and Newton] from `start` by answers that add up, within their reach.
ResponseFit fit_responses(const std::vector<const ResponseModel*>& answers,
                          const Eigen::VectorXd& data, const Eigen::VectorXd& start);
/// The same by one, from where it may be; amplitudes of 0 if that leaves no less than there was.
ResponseFit fit_response(const ResponseModel& answer, const Eigen::VectorXd& data);

}  // namespace lilytank
