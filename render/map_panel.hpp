// One map with its axes and colours.
#pragma once
#include "canvas.hpp"
#include "lilytank/render.hpp"

namespace lilytank {

/// Where a panel's square lies on the page, units.
struct PanelPlace {
  double left = 0, top = 0, size = 340;
  bool y_numbers = true;  ///< and the axis' name
  double beside = 0;      ///< units, right of it, that its title may take
  double right() const { return left + size; }
  double bottom() const { return top + size; }
};

/// The range of a panel's colours.
struct ColourRange {
  double low = 0, high = 1;
  bool cut_low = false, cut_high = false;  ///< there are values beyond
  double share(double value) const { return (value - low) / (high - low); }
};
ColourRange colour_range(const MapPanel& panel);

/// The cells, hatching, arrows and tank circle of a panel, its axes and title.
void draw_panel(const Canvas& canvas, const MapPanel& panel, double tank_radius,
                const PanelPlace& place);
/// Its colour bar, or the legend of its classes, right of `place`.
void draw_scale(const Canvas& canvas, const MapPanel& panel, const PanelPlace& place);
/// A hatched sample at (x, y), its lower left, and what it means beside it.
void draw_hatching_key(const Canvas& canvas, const std::string& meaning, double x, double y);
/// Whether one colour bar can serve both.
bool same_scale(const MapPanel& a, const MapPanel& b);

}  // namespace lilytank
