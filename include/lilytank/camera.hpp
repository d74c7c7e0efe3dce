// A camera over a simulated tank: what a tracker would have recorded of a world whose truth is
// known. Every number is a function of the seed.
#pragma once
#include <cstdint>

#include "lilytank/recording.hpp"
#include "lilytank/trajectory.hpp"

namespace lilytank {

struct Camera {
  double rate = 30;                ///< frames per second
  double position_noise = 0.0003;  ///< m, deviation per axis, independent in every frame
  double heading_noise = 0.01;     ///< rad, likewise
  double dropped = 0;              ///< probability that a frame is missing for all bodies
  double missed = 0;               ///< probability that a body is not seen in a frame
  double latency = 0;              ///< s, a frame shows where bodies were this long before its time
  double swaps = 0;                ///< 1/s, rate at which two bodies that are near are exchanged
  double swap_distance = 0.045;    ///< m, how near
  double lens = 0;                 ///< 1/m^2: places are seen at x (1 + lens |x|^2)
  double tilt = 0;                 ///< rad, of the camera's axis from the vertical, aimed at the
                                   ///< tank's centre; rescaled so that the centre's scale is 1
  double tilt_direction = 0;       ///< rad, in which the axis leans
  double height = 1;               ///< m, of the camera above the tank's centre
  bool headings = true;            ///< whether headings are tracked (of balls never)
  std::uint64_t seed = 1;
};

/// What the camera recorded of the modules (BodyKind::lily), or of the balls. Poses between stored
/// frames are interpolated linearly: exact if every step was stored. Ids are body numbers, balls
/// count from 0. Throws InputError if the trajectory is shorter than a frame.
Recording film(const Trajectory& trajectory, const Camera& camera, BodyKind body = BodyKind::lily);

}  // namespace lilytank
