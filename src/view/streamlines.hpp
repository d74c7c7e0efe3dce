// Curves along a flow, spread evenly over the tank, after B. Jobard and W. Lefer, "Creating
// evenly-spaced streamlines of arbitrary density", Visualization in Scientific Computing (1997).
#pragma once
#include <vector>

#include "lilytank/flow_field.hpp"

namespace lilytank {

/// A curve along the mean flow: points (m) a constant step apart, and the speed there (m/s, of the
/// field, before K_v).
struct Streamline {
  std::vector<Vec2> points;
  std::vector<double> speed;
};

struct StreamlineSettings {
  double radius = 0.30;       ///< m, lines stay inside
  double separation = 0.016;  ///< m, distance between neighbouring lines
  double step = 0.002;        ///< m, length of a piece
  double shortest = 0.03;     ///< m, shorter lines are left out
};

/// Streamlines of the mean velocity; none where the water stands still.
std::vector<Streamline> streamlines(const FlowField& field, const StreamlineSettings& settings);

/// The highest mean speed of the field inside a radius (m/s, before K_v).
double peak_speed(const FlowField& field, double radius);

}  // namespace lilytank
