// What the colours and signs of a frame mean.
#pragma once
#include "canvas.hpp"
#include "lilytank/render.hpp"

namespace lilytank {

/// Draws the legend of a run with its top left corner at (x, y), `width` units wide: control
/// states, faces, marks and flow, as far as they can appear on its frames. `field`: the flow in
/// force (pumps.hpp).
void draw_legend(const Canvas& canvas, const StoredRun& run, const FrameStyle& style, int field,
                 double x, double y, double width);
/// Its height (units).
double legend_height(const StoredRun& run, const FrameStyle& style);

}  // namespace lilytank
