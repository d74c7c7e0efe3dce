// Position, velocity and acceleration from noisy tracks, each with its uncertainty.
//
// Two smoothers. Both look at frames before and after the one they estimate.
//
// `kalman`: a Kalman filter and a Rauch-Tung-Striebel pass back [Rauch, Tung and Striebel, AIAA J.
// 3, 1965] for a body whose acceleration along each axis wanders about zero with some deviation and
// memory [Singer, IEEE Trans. AES 6, 1970], which random jolts push on top of that, and which is
// seen with white noise. All four numbers are those under which the tracks themselves are most
// likely, so nothing has to be chosen. Without jolts and with a long memory it is a quintic
// smoothing spline, with jolts only a cubic one.
//
// `polynomial`: in a window about each frame, the polynomial that fits best [Savitzky and Golay,
// Anal. Chem. 36, 1964]. Its transfer function depends on nothing but window, degree and rate; its
// uncertainty is that of noise only and leaves out what the window rounds off.
#pragma once
#include <cstdint>
#include <vector>

#include "lilytank/recording.hpp"

namespace lilytank {

/// See the top of this file.
enum class SmoothingMethod : std::uint8_t { kalman, polynomial };

/// How a coordinate moves and how well it was seen. Units are those of the coordinate: m, or rad.
struct MotionModel {
  double noise = 0;         ///< deviation of one measurement
  double acceleration = 0;  ///< deviation of the lasting acceleration along one axis, per s^2
  double memory = 0;        ///< s, in which that falls to 1/e; at least two frames
  /// Deviation of the velocity's change by forces too short to be seen as an acceleration, in one
  /// second: per s^(3/2).
  double jolts = 0;
  /// Log-likelihood of the samples under the fitted model; comparable only between models of the
  /// same samples.
  double log_likelihood = 0;
  /// Frames that the estimate rests on; 0: it was given, or there is nothing to estimate from.
  std::int64_t samples = 0;
};

/// Choice of the smoother. Noise levels that are 0 are estimated from the tracks.
struct SmoothingOptions {
  SmoothingMethod method = SmoothingMethod::kalman;
  double window = 0.3;  ///< s, full width of the polynomial's window; at least degree + 2 frames
  int degree = 3;       ///< of the polynomial, 2 .. 5
  double noise = 0;     ///< m, of a measured position; 0: estimated
  double heading_noise = 0;  ///< rad; 0: estimated
};

/// One coordinate or two that are seen together, frame by frame. Frames in which nothing was seen
/// are interpolated from the frames around them, with a larger uncertainty; where that is
/// impossible (polynomials with too few frames in the window), every value is NaN. Under jolts a
/// body has no acceleration at an instant: the Kalman smoother's is the change of velocity from the
/// frame before to the frame after, by the time between them (at the ends of a track, on one side).
struct SmoothTrack {
  std::int64_t id = 0;
  int first = 0;                               ///< frame, as in the track
  std::vector<std::uint8_t> seen;              ///< 1: the frame has a measurement
  std::vector<double> x, y, vx, vy, ax, ay;    ///< m, m/s, m/s^2
  std::vector<double> sd_x, sd_v, sd_a;        ///< deviation of the error along one axis
  std::vector<double> theta, spin, spin_rate;  ///< rad, rad/s, rad/s^2; empty without headings
  /// Standard deviations of the errors of these, rad, rad/s, rad/s^2.
  std::vector<double> sd_theta, sd_spin, sd_spin_rate;
  std::int64_t assembly = -1;  ///< as in the track
  int frames() const { return static_cast<int>(x.size()); }
  std::int64_t unit() const { return assembly < 0 ? id : assembly; }  ///< as of the track
};

/// A recording's tracks, smoothed, in their order.
struct SmoothRecording {
  double rate = 30;      ///< frames per second
  MotionModel position;  ///< of x and y
  MotionModel heading;
  SmoothingOptions options;
  std::vector<SmoothTrack> tracks;  ///< in the recording's order
};

/// Smooths every track. Throws InputError on a rate, window or degree that cannot be used.
SmoothRecording smooth(const Recording& recording, const SmoothingOptions& options = {});

/// The most likely model of a recording's positions (of its headings): from all of its frames, or
/// from pieces spread over them where there are more than some 20,000. `noise` > 0 is kept. Tracks
/// of fewer than eight frames are excluded; with none that is longer, everything is 0.
MotionModel fit_position(const Recording& recording, double noise = 0);
/// The same for headings, rad.
MotionModel fit_heading(const Recording& recording, double noise = 0);

/// What a smoother does to a motion of one frequency, far from ends and gaps: the amplitude of the
/// estimate over that of the truth. White noise of deviation s in the measurements becomes
/// s * noise_gain in the estimate.
struct TransferFunction {
  std::vector<double> frequency;                         ///< Hz, 0 .. rate / 2
  std::vector<double> position, velocity, acceleration;  ///< 1: unchanged
  double position_cutoff = 0, velocity_cutoff = 0,
         acceleration_cutoff = 0;  ///< hz, where it first falls below 1/sqrt(2); rate / 2 if never
  double position_noise_gain = 0, velocity_noise_gain = 0,
         acceleration_noise_gain = 0;  ///< 1, 1/s, 1/s^2
};
/// The transfer function at `points` frequencies, of the smoother itself: from its answer to one
/// frame that is off. `model` is not used by polynomials.
TransferFunction transfer_function(const SmoothingOptions& options, const MotionModel& model,
                                   double rate, int points = 201);

}  // namespace lilytank
