// A camera over a simulated tank: the recording that a tracker would make of a simulated world.
// Every number is a function of the seed.
#pragma once
#include <cstdint>

#include "lilytank/recording.hpp"
#include "lilytank/trajectory.hpp"

namespace lilytank {

/// Errors of a tracker. The defaults are those of a camera at 30 Hz whose positions are good to 0.3
/// mm.
struct Camera {
  /// Frames per second.
  double rate = 30;
  /// Standard deviation per axis, independent in every frame, m.
  double position_noise = 0.0003;
  /// Standard deviation of a heading, independent in every frame, rad.
  double heading_noise = 0.01;
  /// Probability that a frame is missing for all bodies.
  double dropped = 0;
  /// Probability that a body is not seen in a frame.
  double missed = 0;
  /// A frame shows where bodies were this long before its time, s.
  double latency = 0;
  /// Rate at which the identities of two near bodies are exchanged, 1/s.
  double swaps = 0;
  /// Largest distance of two bodies that can be exchanged, m.
  double swap_distance = 0.045;
  /// Radial distortion, 1/m^2: a body at x is seen at x (1 + lens |x|^2).
  double lens = 0;
  /// Angle of the optical axis from the vertical, rad. The camera aims at the tank's centre, and
  /// images are rescaled so that the scale there is 1.
  double tilt = 0;
  /// Direction in which the axis leans, rad from +x.
  double tilt_direction = 0;
  /// Height of the camera above the tank's centre, m; sets the perspective of a tilted view.
  double height = 1;
  /// Whether headings are tracked (of balls never).
  bool headings = true;
  /// Key of noise, missing frames and exchanged bodies (Stream::camera).
  std::uint64_t seed = 1;
};

/// What the camera recorded of the modules (BodyKind::lily), or of the balls. Poses between stored
/// frames are interpolated linearly: exact if every step was stored. Ids are body numbers, balls
/// count from 0. Throws InputError if the trajectory is shorter than a frame.
Recording film(const Trajectory& trajectory, const Camera& camera, BodyKind body = BodyKind::lily);

}  // namespace lilytank
