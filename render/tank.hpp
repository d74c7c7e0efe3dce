// The tank seen from above: water, rim, inlets, mean flow and scale bar.
#pragma once
#include "canvas.hpp"
#include "layout.hpp"
#include "lilytank/model.hpp"
#include "lilytank/render.hpp"

namespace lilytank {

/// Draws everything of the tank that does not move, with the flow of that number (view/pumps.hpp).
/// Its colour and width show its speed, relative to the fastest water of all of the model's flows.
/// Still water has no inlets.
void draw_tank(const Canvas& canvas, const View& view, const Model& model, FlowStyle flow,
               int number);

/// A bar of 10 cm (5 cm in small tanks) with its left end at (x, y), and its text of 22 units or
/// `least_text`.
void draw_scale_bar(const Canvas& canvas, const View& view, const Model& model, double x, double y,
                    double least_text);

}  // namespace lilytank
