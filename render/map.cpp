#include <algorithm>
#include <array>

#include "io/atomic_file.hpp"
#include "map_panel.hpp"
#include "page_fit.hpp"
#include "palette.hpp"

namespace lilytank {
namespace {

constexpr double kKeyHeight = 30;  // below all panels, units

// The panels on the page.
struct MapPage {
  double width = 0, height = 0;
  std::vector<PanelPlace> places;
  std::vector<std::string> title;
  bool key = false;  ///< of the hatching
};

bool is_hatched(const MapPanel& panel) {
  return std::find(panel.hatched.begin(), panel.hatched.end(), true) != panel.hatched.end();
}

// On paper, inner panels of a row have no numbers at their y axes.
MapPage page_of(const Canvas& ruler, const Map& map, const FigureStyle& style) {
  MapPage page;
  const auto columns = static_cast<std::size_t>(std::max(1, map.columns));
  const double size = map.panel_size;
  const std::size_t n = map.panels.size();
  const std::vector<double> room = room_right(map);
  const auto left = [&](std::size_t column) {
    return column > 0 && style.on_paper() ? MapRoom::inner : MapRoom::left;
  };
  for (std::size_t c = 0; c < std::min(columns, n); ++c) page.width += left(c) + size + room[c];
  page.width = std::max(style.on_paper() ? paper_width(style) : page.width, 100.0);
  page.title = title_lines(ruler, map.title, page.width);
  double y = map.title.empty() ? 0 : 34 + further_lines(page.title);
  for (std::size_t i = 0; i < n;) {
    double x = 0;
    for (std::size_t c = 0; c < columns && i < n; ++c, ++i) {
      page.places.push_back(
          {x + left(c), y + MapRoom::top, size, left(c) >= MapRoom::left, room[c]});
      x += left(c) + size + room[c];
    }
    y += MapRoom::top + size + MapRoom::bottom;
  }
  page.key = !map.hatching.empty() && std::any_of(map.panels.begin(), map.panels.end(), is_hatched);
  page.height = std::max(y + (page.key ? kKeyHeight : 0), 100.0);
  return page;
}

void check(const Map& map) {
  if (map.panel_size < 80 || map.panel_size > 4000) {
    throw InputError("a map must be 80 .. 4000 pixels wide, not " + std::to_string(map.panel_size));
  }
  for (const MapPanel& panel : map.panels) {
    if (panel.cells < 1 || panel.cells > 2000 || !(panel.extent > 0)) {
      throw InputError("a map must have 1 .. 2000 cells a side and a size, not " +
                       std::to_string(panel.cells) + " cells");
    }
  }
}

}  // namespace

void draw_map(const Map& map, const std::string& file, const FigureStyle& style) {
  const PictureFormat format = format_of(file);
  check(map);
  const Map shown = fitted(map, style);
  const MapPage page = page_of(Canvas::raster(8, 8), shown, style);
  Canvas canvas = Canvas::page(format, page.width, page.height, style.on_paper());
  draw_title(canvas, page.title, page.width / 2, 26);
  for (std::size_t i = 0; i < shown.panels.size(); ++i) {
    draw_panel(canvas, shown.panels[i], shown.tank_radius, page.places[i]);
    if (shows_scale(shown, i)) draw_scale(canvas, shown.panels[i], page.places[i]);
  }
  if (page.key) draw_hatching_key(canvas, shown.hatching, MapRoom::left, page.height - 15);
  write_atomically(file, canvas.encoded());
}

}  // namespace lilytank
