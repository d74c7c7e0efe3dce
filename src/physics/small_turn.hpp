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

/// Turns (c, s), float32, by an angle of any size that one slice allows; length kept at 1.
inline void small_turn(float& c, float& s, float angle) {
  float a = angle;
  int doublings = 0;
  for (; a * a > 0.0625f && doublings < 8; ++doublings) a *= 0.5f;
  const float q = a * a;
  float ts = a * (1.0f - (1.0f / 6) * q * (1.0f - (1.0f / 20) * q * (1.0f - (1.0f / 42) * q)));
  float tc = 1.0f - 0.5f * q * (1.0f - (1.0f / 12) * q * (1.0f - (1.0f / 30) * q));
  for (int k = 0; k < doublings; ++k) {
    const float twice = 2.0f * ts, half = tc;
    tc = 1.0f - twice * ts, ts = twice * half;
  }
  const float nc = c * tc - s * ts, ns = c * ts + s * tc;
  const float scale = 1.5f - 0.5f * (nc * nc + ns * ns);
  c = nc * scale, s = ns * scale;
}

/// `r` turned by a small angle in radians, length kept at 1.
inline Rot turned_by(Rot r, double angle) {
  return renormalised(compose(r, small_turn(angle)));
}

}  // namespace lilytank
