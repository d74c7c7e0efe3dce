// Modules that are near each other, for terms that act between two.
#pragma once
#include <algorithm>
#include <cmath>

#include "lilytank/force.hpp"

namespace lilytank {

/// Two modules i < j and the line between their centres.
struct NearPair {
  int i = 0, j = 0;
  double dx = 0, dy = 0;  ///< m, from i to j
  double r = 0;           ///< m, > 0
};

/// Calls visit(NearPair) for every two modules whose centres are nearer than `reach` (m), in
/// ascending order.
template <class Visit>
void for_near_pairs(const Kinematics& k, double reach, Visit&& visit) {
  for (int i = 0; i < k.modules; ++i) {
    for (int j = i + 1; j < k.modules; ++j) {
      const double dx = k.x[j] - k.x[i], dy = k.y[j] - k.y[i], square = dx * dx + dy * dy;
      if (square >= reach * reach || square == 0) continue;
      visit(NearPair{i, j, dx, dy, std::sqrt(square)});
    }
  }
}

/// Adds a force (N) along the line of centres, > 0: attraction.
inline void pull_together(const NearPair& pair, double size, std::span<Wrench> out) {
  const double fx = size * pair.dx / pair.r, fy = size * pair.dy / pair.r;
  out[pair.i].fx += fx, out[pair.i].fy += fy;
  out[pair.j].fx -= fx, out[pair.j].fy -= fy;
}

/// How far two squares are apart, along which direction, and where.
struct SquareGap {
  double gap = 0;         ///< m, by separating axes: exact from face to corner; < 0: overlap
  double nx = 1, ny = 0;  ///< unit normal of a face, from i to j
  /// m, from the centre of i: half way across the gap, in the middle of what faces each other.
  double px = 0, py = 0;
};
/// Of two modules with this side (m).
inline SquareGap square_gap(const Kinematics& k, const NearPair& pair, double side) {
  const double half = side / 2;
  const double cosine = std::fabs(k.c[pair.i] * k.c[pair.j] + k.s[pair.i] * k.s[pair.j]);
  const double sine = std::fabs(k.c[pair.i] * k.s[pair.j] - k.s[pair.i] * k.c[pair.j]);
  const double extent = half * (cosine + sine);
  SquareGap widest{-1e300};
  for (const bool second : {false, true}) {
    const int body = second ? pair.j : pair.i;
    for (const bool across : {false, true}) {
      const double ax = across ? -k.s[body] : k.c[body], ay = across ? k.c[body] : k.s[body];
      const double along = pair.dx * ax + pair.dy * ay, sign = along < 0 ? -1 : 1;
      const double gap = std::fabs(along) - half - extent;
      if (gap <= widest.gap) continue;
      const double nx = sign * ax, ny = sign * ay;
      // Where the other one lies along the face, seen from its middle.
      const double beside = (second ? -1 : 1) * (pair.dy * nx - pair.dx * ny);
      const double low = std::fmax(-half, beside - extent);
      const double high = std::fmin(half, beside + extent);
      const double out = (second ? -1 : 1) * (half + gap / 2), mid = (low + high) / 2;
      const double bx = second ? pair.dx : 0, by = second ? pair.dy : 0;
      widest = {gap, nx, ny, bx + out * nx - mid * ny, by + out * ny + mid * nx};
    }
  }
  return widest;
}

/// Adds a force (N) along the normal at the place of the gap, > 0: attraction.
inline void pull_faces(const NearPair& pair, const SquareGap& at, double size,
                       std::span<Wrench> out) {
  const double fx = size * at.nx, fy = size * at.ny;
  out[pair.i].fx += fx, out[pair.i].fy += fy;
  out[pair.i].torque += at.px * fy - at.py * fx;
  out[pair.j].fx -= fx, out[pair.j].fy -= fy;
  out[pair.j].torque -= (at.px - pair.dx) * fy - (at.py - pair.dy) * fx;
}

}  // namespace lilytank
