// The legend of a plot: which curves it names and where it hides least.
#pragma once
#include <cstddef>
#include <vector>

#include "canvas.hpp"
#include "lilytank/render.hpp"
#include "plot_area.hpp"

namespace lilytank {

/// The legend's box, and whether it lies in the plot's area (else to the right of it).
struct LegendBox {
  double x = 0, y = 0, width = 0, height = 0;
  bool inside = true;
};

/// Width and height of the legend of a plot; 0 where no curve has a name.
LegendBox legend_size(const Canvas& canvas, const Plot& plot);
/// Puts a legend into the corner or edge of the area where it hides the least of the curves;
/// `hidden` becomes the number of their points (spread evenly along the lines) that it covers.
LegendBox place_legend(const LegendBox& size, const Plot& plot, const PlotArea& area,
                       std::size_t& hidden);
void draw_legend_box(const Canvas& canvas, const LegendBox& box, const Plot& plot);

}  // namespace lilytank
