// What an effect does to residuals and to calibrated parameters, by experiments with it.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "finder/response_model.hpp"

namespace lilytank {

/// How residuals answer to an effect.
struct Fingerprint : ResponseModel {
  /// How far the effect moves calibrated parameters: about 0 by amplitude, about others as it is.
  Eigen::MatrixXd moved_first;  ///< [parameter, amplitude]
  Eigen::VectorXd moved_base;   ///< [parameter]
  /// Shares of the parameters' distances from their expected values that calibration still
  /// identifies beside the effect, by its experiments.
  Eigen::VectorXd identifiable_share;  ///< [parameter]
  /// About found amplitudes: what its experiments are off, a row each, by the degrees of freedom.
  Eigen::MatrixXd scatter;
  int experiments = 0;  ///< that it rests on, for each amplitude
  /// The first numbers are known without noise (score_sensitivity.hpp).
  Eigen::Index exact = 0;
  /// Power of the amplitude by which residuals grow, from 1 to 2.5: what makes motion more
  /// irregular is hardly seen while it is small.
  double growth = 1;
  /// Variance of its own noise in every residual, whose deviation is one.
  double noise_at(const Eigen::VectorXd& amplitudes) const;
  Eigen::VectorXd moved(const Eigen::VectorXd& amplitudes) const;
};
/// Largest, and mean square, of the amplitudes at which the first fingerprints are learned.
inline constexpr double kLearnedSize = 1.2, kLearnedSquare = 0.7;
/// How far from found amplitudes the experiments about them are.
Eigen::VectorXd apart(const Eigen::VectorXd& amplitudes);

/// Of several effects at once about amplitudes (each one's, in turn), if they add up.
Fingerprint together(const std::vector<Fingerprint>& fingerprints,
                     const std::vector<Eigen::VectorXd>& amplitudes);

}  // namespace lilytank
