// Free flight of many assemblies at once.
#pragma once

namespace lilytank {

/// Poses and twists of `count` slots, structure of arrays (m, m/s, rad/s), and where the poses go,
/// which must be elsewhere.
struct Flight {
  const double *x, *y, *c, *s, *vx, *vy, *omega;
  int count;
  double *to_x, *to_y, *to_c, *to_s;
};

/// Moves every slot by its twist for h seconds, as small_turn.hpp's turned_by() does: vector code,
/// the same bits whatever the vectors' width.
void fly(const Flight& flight, double h);

}  // namespace lilytank
