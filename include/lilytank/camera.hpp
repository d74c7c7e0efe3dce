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
  double rate = 30;                ///< frames per second
  double position_noise = 0.0003;  ///< standard deviation per axis, independent in every frame, m
  /// Standard deviation of a heading, independent in every frame, rad.
  double heading_noise = 0.01;
  double dropped = 0;  ///< probability that a frame is missing for all bodies
  double missed = 0;   ///< probability that a body is not seen in a frame
  double latency = 0;  ///< a frame shows where bodies were this long before its time, s
  double swaps = 0;    ///< rate at which the identities of two near bodies are exchanged, 1/s
  double swap_distance = 0.045;  ///< largest distance of two bodies that can be exchanged, m
  double lens = 0;  ///< radial distortion, 1/m^2: a body at x is seen at x (1 + lens |x|^2)
  /// Angle of the optical axis from the vertical, rad. The camera aims at the tank's centre, and
  /// images are rescaled so that the scale there is 1.
  double tilt = 0;
  double tilt_direction = 0;  ///< direction in which the axis leans, rad from +x
  /// Height of the camera above the tank's centre, m; sets the perspective of a tilted view.
  double height = 1;
  bool headings = true;    ///< whether headings are tracked (of balls never)
  std::uint64_t seed = 1;  ///< key of noise, missing frames and exchanged bodies (Stream::camera)
};

/// What the camera recorded of the modules (BodyKind::lily), or of the balls. Poses between stored
/// frames are interpolated linearly: exact if every step was stored. Ids are body numbers, balls
/// count from 0. Throws InputError if the trajectory is shorter than a frame.
Recording film(const Trajectory& trajectory, const Camera& camera, BodyKind body = BodyKind::lily);

}  // namespace lilytank
