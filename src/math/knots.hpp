// The basis of nonparametric force laws: straight lines between values at equal distances.
#pragma once
#include <cmath>

namespace lilytank {

/// The two knots that a place lies between, and the share of the second.
struct KnotShare {
  int first = 0, second = 0;
  double share = 0;
};

/// Of `knots` at 0, 1, 2, ...: beyond the ends the value there holds; where the curve is closed,
/// the first knot follows the last one.
inline KnotShare between_knots(double place, int knots, bool closed = false) {
  if (!closed && !(place > 0)) return {0, 0, 0};
  if (!closed && place >= knots - 1) return {knots - 1, knots - 1, 0};
  const double floor = std::floor(place);
  const int first = ((static_cast<int>(floor) % knots) + knots) % knots;
  return {first, (first + 1) % knots, place - floor};
}

}  // namespace lilytank
