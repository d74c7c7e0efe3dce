// Where two shapes touch, or will within a margin: squares, discs, and the round wall.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lilytank/math.hpp"

namespace lilytank::reference {

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

/// How far two shapes are apart along a unit normal that looks from the first to the second, m;
/// negative where they overlap by that much in every direction, or more.
struct Gap {
  double size = 0, nx = 0, ny = 0;
};

/// The largest gap of two squares along the directions of their sides (the separating axis
/// theorem); no more than their distance.
inline Gap separation(const Square& a, const Square& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double a1 = a.r.c * dx + a.r.s * dy, a2 = a.r.c * dy - a.r.s * dx;
  const double b1 = b.r.c * dx + b.r.s * dy, b2 = b.r.c * dy - b.r.s * dx;
  const Rot q = between(a.r, b.r);
  const double reach = a.half + b.half * (std::fabs(q.c) + std::fabs(q.s));
  const bool first_a = std::fabs(a1) >= std::fabs(a2), first_b = std::fabs(b1) >= std::fabs(b2);
  const double ua = first_a ? a1 : a2, ub = first_b ? b1 : b2;
  const bool of_a = std::fabs(ua) >= std::fabs(ub);
  const double u = of_a ? ua : ub, way = u < 0 ? -1 : 1;
  const Rot r = of_a ? a.r : b.r;
  const bool along = of_a ? first_a : first_b;
  return {std::fabs(u) - reach, way * (along ? r.c : -r.s), way * (along ? r.s : r.c)};
}

/// Distance of a square and a disc.
inline Gap separation(const Square& a, const Disc& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double u = a.r.c * dx + a.r.s * dy, v = a.r.c * dy - a.r.s * dx;
  const double past_u = std::fabs(u) - a.half, past_v = std::fabs(v) - a.half;
  double nu = u < 0 ? -1 : 1, nv = v < 0 ? -1 : 1, distance = std::max(past_u, past_v);
  if (past_u > 0 && past_v > 0) {
    distance = std::sqrt(past_u * past_u + past_v * past_v);
    nu *= past_u / distance, nv *= past_v / distance;
  } else {
    (past_u >= past_v ? nv : nu) = 0;
  }
  return {distance - b.radius, a.r.c * nu - a.r.s * nv, a.r.s * nu + a.r.c * nv};
}

inline Gap separation(const Disc& a, const Disc& b) {
  const double dx = b.x - a.x, dy = b.y - a.y, distance = std::sqrt(dx * dx + dy * dy);
  const double gap = distance - a.radius - b.radius;
  return distance > 0 ? Gap{gap, dx / distance, dy / distance} : Gap{gap, 1, 0};
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

}  // namespace lilytank::reference
