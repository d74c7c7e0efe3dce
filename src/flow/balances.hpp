// Momentum balances of balls that touch nothing: how a ball's velocity changed over a tenth of a
// second, and what could be known of its motion shortly before.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lilytank/flow_estimate.hpp"

namespace lilytank {

/// Noise of tracks and of the balls' motion. `kick` is the variance per second that the velocity
/// gains by random forces and gusts along one axis, m^2/s^3.
struct TrackNoise {
  double variance = 0;  ///< m^2, of a measured position along one axis
  double kick = 0;
};

/// How balances are cut out of tracks at one frame rate.
///
/// A velocity is the distance over `half` frames to both sides, by time: the true velocity averaged
/// over 2 half frames, plus noise. A balance compares the velocities at frames q and q + length.
/// The motion before is taken from frames up to q - half - gap: it shares neither a measurement nor
/// a gust with the balance, so that what is random in the balance cannot be seen in it.
struct BalanceShape {
  double interval = 1.0 / 30;  ///< s, of frames
  int half = 1, length = 3, gap = 1;
  double duration() const { return length * interval; }
  double box() const { return 2 * half * interval; }  ///< s, over which a velocity is averaged
  int lead() const { return half + gap + 2 * half; }  ///< frames needed before q
  int tail() const { return length + half; }          ///< frames needed after q
  /// s, from the moment of the velocity before to the middle of the balance.
  double lag() const { return (2 * half + gap + 0.5 * length) * interval; }
  /// Variance of a balance's mean acceleration for a unit kick of forces held for `hold` s.
  double kick_share(double hold) const;
  /// The same for a unit variance of measured positions.
  double noise_share() const { return 4 / (box() * box() * duration() * duration()); }
  /// Variance of a velocity by noise, and of the true velocity about its mean in the box.
  double velocity_noise(double variance) const { return 2 * variance / (box() * box()); }
  double velocity_wander(double kick, double hold) const;
};
/// The shape that suits a rate and noise.
BalanceShape balance_shape(double rate, const TrackNoise& noise, double hold);

/// One balance. Points are at frames q .. q + length of the balance, with trapezoidal weights.
struct Balance {
  double ax, ay;       ///< m/s^2, mean acceleration
  double x0, y0;       ///< m, place before
  double vx0, vy0;     ///< m/s, velocity before
  std::int32_t track;  ///< index into BalanceSet::tracks
  std::int32_t at;     ///< index of frame q in that track
};

struct BalanceSet {
  BalanceShape shape;
  std::vector<const Track*> tracks;
  std::vector<Balance> balances;
  double variance = 0;       ///< m^2, of a measured position, along one axis
  std::int64_t dropped = 0;  ///< excluded: a contact or the wall
};
/// Balances of a recording, one after the other in each track. Whether a ball is going to touch
/// something is judged from its motion up to q only: leaving out what did happen afterwards would
/// prefer kicks away from other balls and the wall.
BalanceSet find_balances(const Recording& recording, const BallPhysics& ball,
                         const BalanceShape& shape, const TrackNoise& noise);

/// Mean square of second differences x(f + lag) - 2 x(f) + x(f - lag), per axis, without the few
/// that contacts make large.
struct SecondDifference {
  double mean_square = 0;
  std::int64_t count = 0;
};
SecondDifference second_difference(std::span<const Recording> recordings, int lag);
/// What a unit kick adds to it, forces being held for `hold` s; noise adds 6 variances.
double second_difference_share(double span, double hold);
/// A first estimate of both from second differences over one frame and over 0.1 s.
TrackNoise track_noise(std::span<const Recording> recordings, double rate, double hold);

}  // namespace lilytank
