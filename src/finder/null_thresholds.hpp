// Thresholds of model selection, from simulated null experiments.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "finder/candidate.hpp"

namespace lilytank {

/// The law of the largest of many numbers (Gumbel's), by its mean and deviation in nulls.
class ExtremeLaw {
 public:
  ExtremeLaw() = default;
  explicit ExtremeLaw(const std::vector<double>& largest);
  double exceeded_with(double probability) const;  ///< the number that is exceeded so often
  double chance_beyond(double value) const;        ///< how often that number is exceeded

 private:
  double mean_ = 0, scale_ = 0;
};

/// Least scale of gains in nulls, relative to chi squared's.
inline constexpr double kLeastScale = 0.5;

/// Share of the false positives that is left to the scan of places (clear_place.hpp); effects,
/// curves and the squared distance have the rest.
inline constexpr double kOfPlaces = 0.1;

/// What nulls reach by chance.
struct NullThresholds {
  ExtremeLaw largest_effect, largest_shape;  ///< largest z of a null
  double effect = 0, shape = 0;              ///< z
  double further = 0;                        ///< z of each effect where several are found
  double misfit = 0;                         ///< squared distance of the named statistics
  double mean_misfit = 0;                    ///< likewise, mean of nulls
};

/// The thresholds, and the scales of gains that they hold for.
struct NullCalibration {
  NullThresholds thresholds;
  std::vector<double> scale, scale_all;  ///< of each candidate
  std::vector<double> shape_scale;       ///< of each curve's knots by themselves
};

/// Gains and thresholds by residuals of nulls, a row each, every one whitened by a covariance that
/// it had no part in. `false_alarms`: share of null experiments that may exceed a threshold.
NullCalibration calibrate_on_nulls(const Eigen::MatrixXd& nulls, const Whitening& whitening,
                                   const std::vector<EffectCandidate>& candidates,
                                   double false_alarms);

}  // namespace lilytank
