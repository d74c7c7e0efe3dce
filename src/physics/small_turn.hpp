// Rotation by the small angles of one step; the general function costs ten times as much.
#pragma once
#include "lilytank/math.hpp"

namespace lilytank {

/// cos and sin of an angle in radians: Taylor sums, exact to rounding, for |angle| <= 0.25; the
/// general function above.
inline Rot small_turn(double angle) {
  if (!(angle * angle <= 0.0625)) return rotation(angle);
  const double q = angle * angle;
  const double s =
      1 - q * (1.0 / 6) *
              (1 - q * (1.0 / 20) *
                       (1 - q * (1.0 / 42) * (1 - q * (1.0 / 72) * (1 - q * (1.0 / 110)))));
  const double c =
      1 -
      q * 0.5 *
          (1 - q * (1.0 / 12) * (1 - q * (1.0 / 30) * (1 - q * (1.0 / 56) * (1 - q * (1.0 / 90)))));
  return {c, angle * s};
}

/// `r` turned by a small angle in radians, length kept at 1.
inline Rot turned_by(Rot r, double angle) {
  return renormalised(compose(r, small_turn(angle)));
}

}  // namespace lilytank
