// The tank seen from above: water, rim, inlets, mean flow and scale bar.
#pragma once
#include "canvas.hpp"
#include "lilytank/model.hpp"
#include "lilytank/render.hpp"

namespace lilytank {

/// From metres (y up, origin in the tank's centre) to drawing units (y down).
struct View {
  double centre_x = 0, centre_y = 0;  ///< units
  double scale = 1;                   ///< units per metre
  double x(double metres) const { return centre_x + scale * metres; }
  double y(double metres) const { return centre_y - scale * metres; }
};

/// Draws everything of the tank that does not move. The flow's colour and width tell its speed.
void draw_tank(const Canvas& canvas, const View& view, const Model& model, FlowStyle flow);

/// A bar of 10 cm (5 cm in small tanks) with its left end at (x, y), units.
void draw_scale_bar(const Canvas& canvas, const View& view, const Model& model, double x, double y);

}  // namespace lilytank
