// The rectangle that curves are drawn in, what curves look like, and the legend that names them.
#pragma once
#include <cmath>

#include "axes.hpp"
#include "canvas.hpp"
#include "lilytank/render.hpp"

namespace lilytank {

/// A place on the page; NaN where a curve has a gap.
struct PagePoint {
  double x = 0, y = 0;
  bool known() const { return std::isfinite(x) && std::isfinite(y); }
};

/// From numbers to units on the page.
struct PlotArea {
  double left = 0, top = 0, width = 1, height = 1;  ///< units
  Axis x, y;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
  /// Place of a value, NaN where the axis cannot show it; far values are held near the area, as
  /// Cairo's numbers overflow beyond some ten thousand units.
  double at_x(double value) const { return left + width * held(x.share(value)); }
  double at_y(double value) const { return bottom() - height * held(y.share(value)); }
  /// Whether a place is within it, or as good as.
  bool holds(const PagePoint& p) const {
    return p.x > left - 1 && p.x < right() + 1 && p.y > top - 1 && p.y < bottom() + 1;
  }

 private:
  static double held(double share) {
    return std::isnan(share) ? share : share < -8 ? -8 : share > 8 ? 8 : share;
  }
};

/// The number of points of a curve: the shorter of x and y.
std::size_t points_of(const Curve& curve);
PagePoint page_point(const PlotArea& area, double x, double y);

/// To be drawn in this order: band or bars, line with its marks, markers. `index` chooses colour,
/// dashes and marker.
void draw_band(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index);
void draw_bars(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index);
void draw_curve(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index);
void draw_marks(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index);
void draw_markers(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index);
/// A short piece of a curve's line with its marker, for legends.
void draw_sample(const Canvas& canvas, const Curve& curve, int index, double x, double y,
                 double width);

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
/// The names of all curves of a page once, in rows: where legends would hide curves.
struct PageKey {
  struct Entry {
    const Curve* curve = nullptr;
    int index = 0;
    std::string text;
    double x = 0, y = 0;  ///< of the sample, from the key's top left corner
  };
  std::vector<Entry> entries;
  std::string title;
  double height = 0;
};
/// `page` must outlive the key.
PageKey page_key(const Canvas& canvas, const PlotPage& page, double width);
void draw_page_key(const Canvas& canvas, const PageKey& key, double top);
void draw_legend_box(const Canvas& canvas, const LegendBox& box, const Plot& plot);

}  // namespace lilytank
