// Where two shapes touch, or will within a margin: squares, discs, and the round wall.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lilytank/math.hpp"

namespace lilytank {

/// A module's outline. `inner`: bit k is set where the assembly goes on beyond side k (0..3: +x,
/// +y, -x, -y of `r`'s frame), so that nothing touches there (Assemblies::inner).
struct Square {
  double x = 0, y = 0;  ///< centre, m
  Rot r;
  double half = 0;  ///< half the side, m
  std::uint8_t inner = 0;
};

/// A ball's outline.
struct Disc {
  double x = 0, y = 0;  ///< centre, m
  double radius = 0;    ///< m
};

/// A point half way between two surfaces and the distance between them along the normal, m;
/// negative where they overlap.
struct Touch {
  double x = 0, y = 0, gap = 0;
};

/// Up to two points with a common unit normal, which looks from the first shape to the second.
struct Manifold {
  double nx = 0, ny = 0;
  int count = 0;
  Touch touch[2];
};

/// A square and the wall: up to four corners, each with its own normal (towards the centre).
struct WallManifold {
  int count = 0;
  double nx[4] = {}, ny[4] = {};
  Touch touch[4];
};

/// Largest gap of two squares along the four directions of their sides (the separating axis
/// theorem), m. Never more than their distance; negative: they overlap by that much.
inline double separation(const Square& a, const Square& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const Rot q = between(a.r, b.r);
  const double a1 = std::fabs(a.r.c * dx + a.r.s * dy), a2 = std::fabs(a.r.c * dy - a.r.s * dx);
  const double b1 = std::fabs(b.r.c * dx + b.r.s * dy), b2 = std::fabs(b.r.c * dy - b.r.s * dx);
  const double reach = a.half + b.half * (std::fabs(q.c) + std::fabs(q.s));
  return std::max(std::max(a1, a2), std::max(b1, b2)) - reach;
}

/// Distance of a square and a disc, m; negative: depth of the overlap.
inline double separation(const Square& a, const Disc& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double u = std::fabs(a.r.c * dx + a.r.s * dy) - a.half;
  const double v = std::fabs(a.r.c * dy - a.r.s * dx) - a.half;
  if (u <= 0 || v <= 0) return std::max(u, v) - b.radius;
  return std::sqrt(u * u + v * v) - b.radius;
}

inline double separation(const Disc& a, const Disc& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return std::sqrt(dx * dx + dy * dy) - a.radius - b.radius;
}

/// Distance of a square's outermost corner from the wall of a tank of radius `tank`, m.
inline double wall_separation(const Square& a, double tank) {
  const double u = std::fabs(a.r.c * a.x + a.r.s * a.y) + a.half;
  const double v = std::fabs(a.r.c * a.y - a.r.s * a.x) + a.half;
  return tank - std::sqrt(u * u + v * v);
}

inline double wall_separation(const Disc& a, double tank) {
  return tank - a.radius - std::sqrt(a.x * a.x + a.y * a.y);
}

/// Where the shapes touch or are nearer than `margin` (m); no points where they are not. The
/// normal is that of the face which separates the squares best (clipped against the other's
/// edge), or joins two corners. Directions into a neighbour on the same lattice are left out, so a
/// body that slides along a row of modules does not catch on their seams.
Manifold collide(const Square& a, const Square& b, double margin);
Manifold collide(const Square& a, const Disc& b, double margin);
Manifold collide(const Disc& a, const Disc& b, double margin);
WallManifold collide_wall(const Square& a, double tank, double margin);
Manifold collide_wall(const Disc& a, double tank, double margin);

}  // namespace lilytank
