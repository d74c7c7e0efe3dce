// Figures on paper: pages of plots and maps, laid out again for a column's width.
#pragma once
#include <string>
#include <vector>

#include "canvas.hpp"
#include "lilytank/render.hpp"

namespace lilytank {

/// Units that a page is wide on paper.
inline double paper_width(const FigureStyle& style) {
  return style.width * kUnitsPerMm;
}

/// The page as `style` wants it: on paper no wider than paper_width(), in as many columns as have
/// room (more where it would be higher than 240 mm); without sentences above it.
PlotPage fitted(PlotPage page, const FigureStyle& style);
/// Likewise; the panels' size changes, and a row keeps its panels or has one.
Map fitted(Map map, const FigureStyle& style);

/// Units around panels of a map.
struct MapRoom {
  static constexpr double left = 62, inner = 16, top = 40, bottom = 54;  ///< inner: no numbers
  static constexpr double bar = 116, classes = 170, none = 12;           ///< right of a panel
};
/// Room right of each column, the same in all rows, so that panels stand below each other: that of
/// its widest scale.
std::vector<double> room_right(const Map& map);
/// Whether a colour bar or legend stands right of a panel: panels of a row share equal ones.
bool shows_scale(const Map& map, std::size_t panel);

/// A sentence above a figure, in lines.
std::vector<std::string> title_lines(const Canvas& canvas, const std::string& title, double width);
/// Height that lines of a title take beyond the first one.
double further_lines(const std::vector<std::string>& lines);
/// Writes them, the first line's baseline at y.
void draw_title(const Canvas& canvas, const std::vector<std::string>& lines, double middle,
                double y);

}  // namespace lilytank
