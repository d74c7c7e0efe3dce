// Forces of laws that depend on one number: the speed, the gap of a pair, the distance from a
// place.
#pragma once
#include <algorithm>
#include <cmath>

#include "bodies/law.hpp"

namespace lilytank::bodies {

using Values = std::span<const double>;

/// Adds to every body a force of `size(speed, p)` times its velocity.
template <auto size>
void along_velocity(const Scene& s, Values p, double* force) {
  for (int b = 0; b < s.bodies; ++b) {
    const double* v = s.v + b * s.dimensions;
    double square = 0;
    for (int d = 0; d < s.dimensions; ++d) square += v[d] * v[d];
    const double by = size(std::sqrt(square), p);
    for (int d = 0; d < s.dimensions; ++d) force[b * s.dimensions + d] += by * v[d];
  }
}

/// Adds to every body a force of `size(speed, p)` times its velocity relative to the medium.
template <auto size>
void along_slip(const Scene& s, Values p, double* force) {
  for (int b = 0; b < s.bodies; ++b) {
    double slip[2] = {0, 0}, square = 0;
    for (int d = 0; d < s.dimensions; ++d) {
      slip[d] = s.v[b * s.dimensions + d] - velocity_of_medium(s, p, d);
      square += slip[d] * slip[d];
    }
    const double by = size(std::sqrt(square), p);
    for (int d = 0; d < s.dimensions; ++d) force[b * s.dimensions + d] += by * slip[d];
  }
}

/// Adds to all pairs a repulsion of `size(gap, p)`, gap: distance less both radii, m.
template <auto size>
void between_pairs(const Scene& s, Values p, double* force) {
  for (int a = 0; a < s.bodies; ++a) {
    for (int b = a + 1; b < s.bodies; ++b) {
      double u[2] = {0, 0}, square = 0;
      for (int d = 0; d < s.dimensions; ++d) {
        u[d] = s.x[b * s.dimensions + d] - s.x[a * s.dimensions + d];
        square += u[d] * u[d];
      }
      const double distance = std::max(std::sqrt(square), 1e-12);
      const double f = size(distance - s.radius[a] - s.radius[b], p) / distance;
      for (int d = 0; d < s.dimensions; ++d) {
        force[b * s.dimensions + d] += f * u[d];
        force[a * s.dimensions + d] -= f * u[d];
      }
    }
  }
}

/// Adds a force that turns velocities clockwise at `rate(s, p)` (rad/s).
template <auto rate>
void turn(const Scene& s, Values p, double* force) {
  const double by = rate(s, p);
  for (int b = 0; b < s.bodies; ++b) {
    const double f = s.mass[b] * by;
    force[2 * b] += f * s.v[2 * b + 1];
    force[2 * b + 1] -= f * s.v[2 * b];
  }
}

/// Adds a force of `size(distance, p)` towards a centre, the last two parameters.
template <auto size>
void towards_centre(const Scene& s, Values p, double* force) {
  for (int b = 0; b < s.bodies; ++b) {
    const double u[2] = {s.x[2 * b] - p[p.size() - 2], s.x[2 * b + 1] - p[p.size() - 1]};
    const double distance = std::max(std::hypot(u[0], u[1]), 1e-12);
    const double f = size(distance, p) / distance;
    for (int d = 0; d < 2; ++d) force[2 * b + d] -= f * u[d];
  }
}

/// Adds a force towards a place: the first parameter times `power` of the distance along each axis.
template <auto power>
void towards_place(const Scene& s, Values p, double* force) {
  for (int i = 0; i < s.bodies * s.dimensions; ++i) {
    force[i] -= p[0] * power(s.x[i] - p[static_cast<std::size_t>(1 + i % s.dimensions)]);
  }
}

}  // namespace lilytank::bodies
