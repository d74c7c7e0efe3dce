// The Kalman filter behind smoothing: a coordinate whose acceleration wanders [Singer 1970].
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "lilytank/smoothing.hpp"

namespace lilytank {

/// Place, velocity, acceleration.
using MotionState = Eigen::Vector3d;
using MotionMatrix = Eigen::Matrix3d;

/// What happens from one frame to the next: state -> F state + noise of covariance Q.
struct Transition {
  MotionMatrix F, Q;
};
/// Over `interval` seconds.
Transition transition(const MotionModel& model, double interval);

/// Measurements of one or two coordinates that are seen in the same frames (NaN: not seen).
struct Axes {
  std::span<const double> first, second;  ///< `second` may be empty
  std::size_t frames() const { return first.size(); }
  int count() const { return second.empty() ? 1 : 2; }
  bool seen(std::size_t f) const { return first[f] == first[f]; }
};

/// Estimates of one coordinate, and their deviations, which all coordinates share.
struct AxisEstimate {
  std::vector<double> value, velocity, acceleration;
};
struct AxesEstimate {
  /// All NaN.
  explicit AxesEstimate(const Axes& axes);
  AxisEstimate axis[2];
  std::vector<double> sd_value, sd_velocity, sd_acceleration;
};

/// Smooths by filter and backward pass.
AxesEstimate smooth_kalman(const Axes& axes, const MotionModel& model, double interval);
/// Smooths by local polynomials.
AxesEstimate smooth_polynomial(const Axes& axes, const SmoothingOptions& options, double noise,
                               double interval);
/// Frames on either side of a polynomial's middle.
int half_window(const SmoothingOptions& options, double interval);
/// The window that is really used, s: a whole, odd number of frames, enough for the polynomial.
inline double used_window(const SmoothingOptions& options, double interval) {
  return (2 * half_window(options, interval) + 1) * interval;
}

/// Sums over innovations: what the likelihood needs.
struct Innovations {
  double squares = 0;       ///< of innovations over their variances
  double log_variance = 0;  ///< sum of logarithms
  std::int64_t count = 0;
};
/// Runs the filter over a piece; its first two measurements only start it.
void add_innovations(const Axes& axes, const MotionModel& model, double interval,
                     Innovations& sums);

/// The most likely model of the pieces. `noise` > 0 is kept.
MotionModel fit_motion(const std::vector<Axes>& pieces, double interval, double noise);

}  // namespace lilytank
