#include <algorithm>
#include <array>

#include "io/atomic_file.hpp"
#include "map_panel.hpp"
#include "palette.hpp"

namespace lilytank {
namespace {

constexpr double kLeft = 62, kTop = 40, kBottom = 54;  // room around a panel, units
constexpr double kKeyHeight = 30;                      // below all panels, units
constexpr double kScale = 116, kClassLegend = 170,
                 kRightGap = 12;  // to its right: bar, legend, nothing

// The panels on the page, and which of them show a scale.
struct MapPage {
  double width = 0, height = 0;
  std::vector<PanelPlace> places;
  std::vector<bool> scales;
  bool key = false;  ///< of the hatching
};

bool is_hatched(const MapPanel& panel) {
  return std::find(panel.hatched.begin(), panel.hatched.end(), true) != panel.hatched.end();
}

MapPage page_of(const Map& map) {
  MapPage page;
  const auto columns = static_cast<std::size_t>(std::max(1, map.columns));
  const double size = map.panel_size;
  const std::size_t n = map.panels.size();
  page.scales.assign(n, true);
  // Room right of a column is the same in all rows, so that panels stand below each other.
  std::vector<double> room(columns, kRightGap);
  for (std::size_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n || (i + 1) % columns == 0;
    page.scales[i] = last || !same_scale(map.panels[i], map.panels[i + 1]);
    if (!page.scales[i]) continue;
    double& r = room[i % columns];
    r = std::max(r, map.panels[i].classes.empty() ? kScale : kClassLegend);
  }
  double y = map.title.empty() ? 0 : 34;
  for (std::size_t i = 0; i < n;) {
    double x = 0;
    for (std::size_t c = 0; c < columns && i < n; ++c, ++i) {
      page.places.push_back({x + kLeft, y + kTop, size});
      x += kLeft + size + room[c];
    }
    page.width = std::max(page.width, x);
    y += kTop + size + kBottom;
  }
  page.key = !map.hatching.empty() && std::any_of(map.panels.begin(), map.panels.end(), is_hatched);
  page.height = std::max(y + (page.key ? kKeyHeight : 0), 100.0);
  page.width = std::max(page.width, 100.0);
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

void draw_map(const Map& map, const std::string& file) {
  const PictureFormat format = format_of(file);
  check(map);
  const MapPage page = page_of(map);
  Canvas canvas = Canvas::page(format, page.width, page.height);
  const TextStyle title{17, palette::ink, true, Align::centre};
  canvas.text(page.width / 2, 26, canvas.fitted(map.title, page.width - 20, title), title);
  for (std::size_t i = 0; i < map.panels.size(); ++i) {
    draw_panel(canvas, map.panels[i], map.tank_radius, page.places[i]);
    if (page.scales[i]) draw_scale(canvas, map.panels[i], page.places[i]);
  }
  if (page.key) draw_hatching_key(canvas, map.hatching, kLeft, page.height - 15);
  write_atomically(file, canvas.encoded());
}

}  // namespace lilytank
