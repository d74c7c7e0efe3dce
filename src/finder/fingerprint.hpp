// What an effect does to residuals and to calibrated parameters, by experiments with it.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "effects/effects.hpp"
#include "finder/response_model.hpp"

namespace lilytank {

/// Response of the residuals to an effect.
struct Fingerprint : ResponseModel {
  /// Change of the calibrated parameters: slope in the amplitude, and value at `about`.
  Eigen::MatrixXd moved_first;  ///< [parameter, amplitude]
  Eigen::VectorXd moved_base;   ///< [parameter]
  /// Shares of the parameters' distances from their expected values that calibration still
  /// identifies beside the effect, by its experiments.
  Eigen::VectorXd identifiable_share;  ///< [parameter]
  /// Residuals of its experiments, a row each, scaled by the degrees of freedom; empty about 0.
  Eigen::MatrixXd scatter;
  int experiments = 0;  ///< simulated for each amplitude
  /// The first numbers are known without noise (score_sensitivity.hpp).
  Eigen::Index exact = 0;
  /// Power of the amplitude by which residuals grow, from 1 to 2.5: an effect
  /// that makes motion more irregular is hardly visible while it is weak.
  double growth = 1;
  /// Variance of its own noise, relative to a residual's variance under the null hypothesis.
  double noise_at(const Eigen::VectorXd& amplitudes) const;
  Eigen::VectorXd moved(const Eigen::VectorXd& amplitudes) const;
};
/// Experiments that first fingerprints are learned from.
struct Learning {
  /// For each amplitude of an effect; of one with a force, the filter computes the scores' response
  /// up to a factor (score_sensitivity.hpp). Nothing is known beforehand of one of the control: by
  /// five experiments each, 7 of 12 recordings got a wrong name, by fifteen 2.
  int each = 5, with_force = 3, of_control = 15;
  int of(const Effect& effect) const {
    if (effect.control()) return of_control;
    return effect.mean_force ? with_force : each;
  }
  int in_all(const Effect& effect) const {
    return of(effect) * static_cast<int>(effect.paths.size());
  }
};

/// Largest, and mean square, of the amplitudes at which the first fingerprints are learned.
inline constexpr double kLearnedSize = 1.2, kLearnedSquare = 0.7;
/// How far from found amplitudes of an effect the experiments about them are.
Eigen::VectorXd apart(const Effect& effect, const Eigen::VectorXd& amplitudes);
/// Largest distance from the amplitudes of experiments at which these serve, in that spread:
/// experiments about 0.8 of a strong torque left a residual that a law of radius fitted better.
inline constexpr double kBeside = 0.5;

/// Random amplitudes between 0.4 and kLearnedSize of an effect's sizes, a row each, of both signs
/// if it is two-sided; several components at once, none always present.
Eigen::MatrixXd learning_amplitudes(const Effect& effect, int count, std::uint64_t seed);
/// Amplitudes about estimated ones, a row each, in antithetic pairs.
Eigen::MatrixXd amplitudes_about(const Effect& effect, const Eigen::VectorXd& amplitudes, int count,
                                 std::uint64_t seed);

/// Of several effects at once about amplitudes (each one's, in turn), if they add up.
Fingerprint together(const std::vector<Fingerprint>& fingerprints,
                     const std::vector<Eigen::VectorXd>& amplitudes);

}  // namespace lilytank
