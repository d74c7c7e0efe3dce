// What laws along the velocity share.
#pragma once
#include <cmath>

#include "bodies/law.hpp"

namespace lilytank::bodies {

/// Adds to every body a force of `size(speed)` times its velocity.
template <class Size>
void along_velocity(const Scene& s, double* force, Size&& size) {
  for (int b = 0; b < s.bodies; ++b) {
    const double* v = s.v + b * s.dimensions;
    double square = 0;
    for (int d = 0; d < s.dimensions; ++d) square += v[d] * v[d];
    const double by = size(std::sqrt(square));
    for (int d = 0; d < s.dimensions; ++d) force[b * s.dimensions + d] += by * v[d];
  }
}

}  // namespace lilytank::bodies
