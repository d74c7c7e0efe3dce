#include "page_fit.hpp"

#include <algorithm>
#include <cmath>

#include "cut_text.hpp"
#include "map_panel.hpp"
#include "palette.hpp"

namespace lilytank {
namespace {

constexpr double kHighest = 240 * kUnitsPerMm;       // of a page
constexpr double kHighestPlots = 220 * kUnitsPerMm;  // without title and legend
constexpr double kLeastPlot = 300;    // units wide: below, numbers at the axis take most of a plot
constexpr double kNarrowest = 200;    // of a plot on a page that would otherwise be too high
constexpr double kLowestShare = 0.7;  // of a narrow plot's width
constexpr double kLowest = 210, kTallest = 560;  // units high, of a plot
constexpr double kLargestPanel = 480;            // units, of a map
constexpr double kTitleLine = 21;
const TextStyle kSentence{17, palette::ink, true, Align::centre};

// Rows of named values keep their height, others their proportions. A title comes on top.
int height_at(const Canvas& ruler, const Plot& plot, double width) {
  const auto title = title_lines(ruler, plot.title, width);
  const double head = title.empty() ? 0 : 28 + further_lines(title);
  if (!plot.y_names.empty()) return plot.height + static_cast<int>(further_lines(title));
  const double lowest = std::min(kLowest, kLowestShare * width);
  const double height = std::clamp(plot.height * width / plot.width, lowest, kTallest);
  return static_cast<int>(height + head);
}

double height_at(const Canvas& ruler, const PlotPage& page, int columns, double width) {
  double height = 0, row = 0;
  for (std::size_t i = 0; i < page.plots.size(); ++i) {
    if (i % static_cast<std::size_t>(columns) == 0) height += row, row = 0;
    row = std::max<double>(row, height_at(ruler, page.plots[i], width));
  }
  return height + row;
}

// Side of the panels in so many columns.
double panel_size(Map map, int columns, double width) {
  map.columns = columns;
  double beside = MapRoom::left + (columns - 1) * MapRoom::inner;
  for (const double room : room_right(map)) beside += room;
  const auto n = static_cast<int>(map.panels.size());
  const double rows = std::ceil(static_cast<double>(n) / columns), around = 3 * kTitleLine;
  return std::min({(width - beside) / columns,
                   (kHighest - around) / rows - MapRoom::top - MapRoom::bottom, kLargestPanel});
}

}  // namespace

PlotPage fitted(PlotPage page, const FigureStyle& style) {
  if (style.untitled) {
    page.title.clear();
    if (page.plots.size() == 1) page.plots[0].title.clear();
  }
  if (!style.on_paper()) return page;
  const Canvas ruler = Canvas::raster(8, 8);
  const double wide = paper_width(style);
  const int given = std::max(1, std::min(page.columns, static_cast<int>(page.plots.size())));
  int columns = std::clamp(static_cast<int>(wide / kLeastPlot), 1, given);
  const int most = std::clamp(static_cast<int>(wide / kNarrowest), columns, given);
  while (columns < most && height_at(ruler, page, columns, wide / columns) > kHighestPlots)
    ++columns;
  for (Plot& plot : page.plots) {
    plot.height = height_at(ruler, plot, wide / columns);
    plot.width = static_cast<int>(wide / columns);
  }
  page.columns = columns;
  return page;
}

Map fitted(Map map, const FigureStyle& style) {
  if (style.untitled) map.title.clear();
  if (!style.on_paper() || map.panels.empty()) return map;
  const double wide = paper_width(style);
  const int given = std::clamp(map.columns, 1, static_cast<int>(map.panels.size()));
  map.columns = panel_size(map, given, wide) >= panel_size(map, 1, wide) ? given : 1;
  map.panel_size = std::max(80, static_cast<int>(panel_size(map, map.columns, wide)));
  return map;
}

std::vector<double> room_right(const Map& map) {
  const auto columns = static_cast<std::size_t>(std::max(1, map.columns));
  const std::size_t n = map.panels.size();
  std::vector<double> room(columns, MapRoom::none);
  for (std::size_t i = 0; i < n; ++i) {
    if (!shows_scale(map, i)) continue;
    double& r = room[i % columns];
    r = std::max(r, map.panels[i].classes.empty() ? MapRoom::bar : MapRoom::classes);
  }
  return room;
}

bool shows_scale(const Map& map, std::size_t panel) {
  const auto columns = static_cast<std::size_t>(std::max(1, map.columns));
  const bool last = panel + 1 == map.panels.size() || (panel + 1) % columns == 0;
  return last || !same_scale(map.panels[panel], map.panels[panel + 1]);
}

std::vector<std::string> title_lines(const Canvas& canvas, const std::string& title, double width) {
  return lines_within(title, width - 20,
                      [&](const std::string& text) { return canvas.width_of(text, kSentence); });
}

double further_lines(const std::vector<std::string>& lines) {
  return lines.size() < 2 ? 0 : kTitleLine * static_cast<double>(lines.size() - 1);
}

void draw_title(const Canvas& canvas, const std::vector<std::string>& lines, double middle,
                double y) {
  for (const std::string& line : lines) {
    canvas.text(middle, y, line, kSentence);
    y += kTitleLine;
  }
}

}  // namespace lilytank
