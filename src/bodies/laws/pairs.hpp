// What laws between two bodies share.
#pragma once
#include <algorithm>
#include <cmath>

#include "bodies/law.hpp"

namespace lilytank::bodies {

/// Adds to all pairs a repulsion of `size(gap)`, gap: distance less both radii, m.
template <class Size>
void between_pairs(const Scene& s, double* force, Size&& size) {
  for (int a = 0; a < s.bodies; ++a) {
    for (int b = a + 1; b < s.bodies; ++b) {
      double u[2] = {0, 0}, square = 0;
      for (int d = 0; d < s.dimensions; ++d) {
        u[d] = s.x[b * s.dimensions + d] - s.x[a * s.dimensions + d];
        square += u[d] * u[d];
      }
      const double distance = std::max(std::sqrt(square), 1e-12);
      const double f = size(distance - s.radius[a] - s.radius[b]) / distance;
      for (int d = 0; d < s.dimensions; ++d) {
        force[b * s.dimensions + d] += f * u[d];
        force[a * s.dimensions + d] -= f * u[d];
      }
    }
  }
}

/// A law of the gap; `size` is its force at a gap for its parameters.
class PairLaw : public Law {
 public:
  std::string_view variable() const override { return "pair"; }
  std::string_view split() const override {
    return "faster approaches, to half the smallest gap, and slow ones that turn at twice of it";
  }
  bool possible(const Typical& t) const override { return t.bodies > 1; }
  void add(const Scene& s, std::span<const double> p, double* force) const override {
    between_pairs(s, force, [&](double gap) { return size(gap, p); });
  }
  virtual double size(double gap, std::span<const double> p) const = 0;
};

}  // namespace lilytank::bodies
