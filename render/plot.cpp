#include <algorithm>
#include <array>
#include <cmath>

#include "io/atomic_file.hpp"
#include "page_fit.hpp"
#include "palette.hpp"
#include "plot_area.hpp"

namespace lilytank {
namespace {

constexpr double kMajor = 6, kMinor = 3.5;  // tick lengths
constexpr double kMargin = 26;              // units, to the right of the area
constexpr double kBeside = 24;              // units, around a legend beside the area
const TextStyle kTickText{14, palette::ink, false, Align::left};
const TextStyle kLabelText{16, palette::ink, false, Align::centre};

struct DataRange {
  Range x, y;
};

DataRange range_of(const Plot& plot) {
  DataRange r;
  for (const Curve& curve : plot.curves) {
    for (std::size_t i = 0; i < points_of(curve); ++i) {
      // A point counts only if both of its numbers can be shown.
      const bool shown = std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]) &&
                         (!plot.log_x || curve.x[i] > 0) && (!plot.log_y || curve.y[i] > 0);
      if (!shown) continue;
      r.x.add(curve.x[i], plot.log_x);
      r.y.add(curve.y[i], plot.log_y);
      if (i < curve.low.size() && i < curve.high.size()) {
        r.y.add(curve.low[i], plot.log_y);
        r.y.add(curve.high[i], plot.log_y);
      }
    }
  }
  return r;
}

// Room at the ends of the vertical axis; an axis whose data begin near zero begins at zero.
void widen(double& low, double& high, bool log) {
  if (log) {
    const double k = std::pow(high / low, 0.05);
    if (std::isfinite(k) && k > 1) low /= k, high *= k;
    return;
  }
  const double span = high - low;
  if (!std::isfinite(span)) return;
  const bool from_zero = low >= 0 && low < 0.35 * high;
  low = from_zero ? 0 : low - 0.05 * span;
  high += 0.05 * span;
}

bool is_range(double low, double high) {
  return low < high && std::isfinite(low) && std::isfinite(high);
}

// From the last name at the bottom to the first at the top.
Axis named_axis(const std::vector<std::string>& names) {
  const auto n = static_cast<double>(names.size());
  Axis axis{n - 0.5, -0.5, false, {}, {}};
  for (std::size_t k = names.size(); k-- > 0;) {
    axis.ticks.push_back({static_cast<double>(k), names[k], true});
  }
  return axis;
}

void choose_axes(const Plot& plot, PlotArea& area) {
  // Units from a number to the next: small plots have at least a few of them.
  const double x_step = area.width >= 450 ? 110 : plot.log_x ? 55 : 80;
  const double y_step = area.height < 260 ? 35 : 70;
  const DataRange data = range_of(plot);
  double low = data.x.empty() ? (plot.log_x ? 0.1 : 0) : data.x.low();
  double high = data.x.empty() ? (plot.log_x ? 10 : 1) : data.x.high();
  if (is_range(plot.x_low, plot.x_high)) low = plot.x_low, high = plot.x_high;
  area.x = make_axis(low, high, plot.log_x, static_cast<int>(area.width / x_step),
                     data.x.whole() && !data.x.empty());
  if (!plot.y_names.empty()) {
    area.y = named_axis(plot.y_names);
    return;
  }
  low = data.y.empty() ? (plot.log_y ? 0.1 : 0) : data.y.low();
  high = data.y.empty() ? (plot.log_y ? 10 : 1) : data.y.high();
  if (is_range(plot.y_low, plot.y_high))
    low = plot.y_low, high = plot.y_high;
  else if (high > low)
    widen(low, high, plot.log_y);
  area.y = make_axis(low, high, plot.log_y, static_cast<int>(area.height / y_step),
                     data.y.whole() && !data.y.empty());
}

double widest_label(const Canvas& canvas, const Axis& axis) {
  double widest = 0;
  for (const AxisTick& t : axis.ticks)
    widest = std::max(widest, canvas.width_of(t.label, kTickText));
  return widest;
}

// What is left free at the sides of the area.
struct Margins {
  double left = 0, right = kMargin;  // units; the left one at least so wide
  bool legends = false;              // they stand on the right, beside the area
  bool key = false;                  // or once below all plots
};

// The area depends on the labels' widths, which depend on the area's size: two rounds settle it.
PlotArea layout(const Canvas& canvas, const Plot& plot, const Margins& margins) {
  PlotArea area;
  area.left = std::max(80.0, margins.left);
  for (int round = 0; round < 2; ++round) {
    const auto title = title_lines(canvas, plot.title, plot.width);
    area.top = title.empty() ? 22 : 50 + further_lines(title);
    area.width = std::max(40.0, plot.width - area.left - margins.right);
    area.height = std::max(40.0, plot.height - area.top - (plot.x_label.empty() ? 40 : 66));
    choose_axes(plot, area);
    if (!area.y.note.empty()) area.top += 14, area.height = std::max(40.0, area.height - 14);
    area.left =
        std::max(margins.left, widest_label(canvas, area.y) + 18 + (plot.y_label.empty() ? 8 : 32));
  }
  area.width = std::max(40.0, plot.width - area.left - margins.right);
  return area;
}

bool leaves_room(const LegendBox& legend, const Plot& plot) {
  return legend.height > 0 && legend.width < 0.45 * plot.width;
}

// Whether a legend in the area would hide much.
bool is_crowded(const Canvas& canvas, const Plot& plot, const PlotArea& area, bool on_paper) {
  const std::size_t most = on_paper ? 0 : 6;  // hidden points of ink; paper has room below
  const LegendBox legend = legend_size(canvas, plot);
  if (legend.height <= 0) return false;
  std::size_t hidden = 0;
  place_legend(legend, plot, area, hidden);
  return hidden > most || legend.height > area.height - 20 || legend.width > 0.6 * area.width;
}

// Plots of a page have the same margins: panels are equally large, and axes above each other agree.
// Legends without room in the area go beside a plot that is alone, where that leaves room for it;
// on paper, and of several plots, below all.
Margins margins_of(const Canvas& canvas, const PlotPage& page, const FigureStyle& style) {
  Margins all;
  bool crowded = false;
  for (const Plot& plot : page.plots) {
    const PlotArea area = layout(canvas, plot, {});
    all.left = std::max(all.left, area.left);
    crowded = crowded || is_crowded(canvas, plot, area, style.on_paper());
  }
  all.key = crowded && (style.on_paper() || page.plots.size() > 1);
  all.legends = crowded && !all.key;
  for (const Plot& plot : page.plots) {
    const LegendBox legend = legend_size(canvas, plot);
    if (all.legends && leaves_room(legend, plot)) {
      all.right = std::max(all.right, legend.width + kBeside);
    }
  }
  return all;
}

void draw_grid(const Canvas& canvas, const PlotArea& area) {
  const Colour faint = mixed(palette::hairline, palette::paper, 0.45);
  for (const AxisTick& t : area.x.ticks) {
    const double x = area.at_x(t.value);
    if (t.major) canvas.line(x, area.top, x, area.bottom(), faint, 1);
  }
  for (const AxisTick& t : area.y.ticks) {
    const double y = area.at_y(t.value);
    if (t.major) canvas.line(area.left, y, area.right(), y, faint, 1);
  }
}

void draw_zero_line(const Canvas& canvas, const PlotArea& area) {
  const double y = area.at_y(0);
  if (!(y > area.top && y < area.bottom())) return;
  canvas.line(area.left, y, area.right(), y, palette::muted, 1);
}

void draw_frame_and_ticks(const Canvas& canvas, const PlotArea& area) {
  constexpr double kWidth = 1.1;
  cairo_rectangle(canvas.get(), area.left, area.top, area.width, area.height);
  canvas.stroke(palette::ink, kWidth);
  TextStyle text = kTickText;
  text.align = Align::centre;
  double free_from = -1e9;  // labels that would touch the one before are left out
  for (const AxisTick& t : area.x.ticks) {
    const double x = area.at_x(t.value), y = area.bottom();
    canvas.line(x, y, x, y - (t.major ? kMajor : kMinor), palette::ink, kWidth);
    const double half = canvas.width_of(t.label, text) / 2;
    if (t.label.empty() || x - half < free_from) continue;
    canvas.text(x, y + 20, t.label, text);
    free_from = x + half + 8;
  }
  text.align = Align::right;
  double free_below = 1e9;
  for (const AxisTick& t : area.y.ticks) {
    const double x = area.left, y = area.at_y(t.value);
    canvas.line(x, y, x + (t.major ? kMajor : kMinor), y, palette::ink, kWidth);
    if (t.label.empty() || y > free_below) continue;
    canvas.text(x - 8, y + 5, t.label, text);
    free_below = y - 18;
  }
  const TextStyle note{13, palette::muted, false, Align::right};
  if (!area.x.note.empty()) canvas.text(area.right(), area.bottom() + 38, area.x.note, note);
  if (!area.y.note.empty()) {
    canvas.text(area.left, area.top - 8, area.y.note, {13, palette::muted, false, Align::left});
  }
}

struct AxisName {
  std::string text;
  TextStyle style = kLabelText;
};

// A name that is longer than `room` is set smaller, then cut to `most`.
AxisName name_within(const Canvas& canvas, const std::string& name, double room, double most) {
  AxisName out;
  while (out.style.size > 13 && canvas.width_of(name, out.style) > room) out.style.size -= 1;
  out.text = canvas.fitted(name, most, out.style);
  return out;
}

void draw_titles(const Canvas& canvas, const Plot& plot, const PlotArea& area) {
  const double middle = area.left + area.width / 2;
  draw_title(canvas, title_lines(canvas, plot.title, plot.width), plot.width / 2.0, 30);
  constexpr double kEdge = 8;  // the name below may pass the area's ends, and leave its middle
  const double beside = std::min(middle, plot.width - middle) - kEdge;
  const AxisName x = name_within(canvas, plot.x_label, 2 * beside, plot.width - 2 * kEdge);
  const double half = canvas.width_of(x.text, x.style) / 2;
  canvas.text(std::min(middle, plot.width - kEdge - half), area.bottom() + 46, x.text, x.style);
  const double room = area.height + 40;
  const AxisName y = name_within(canvas, plot.y_label, room, room);
  canvas.upright_text(24, area.top + area.height / 2, y.text, y.style);
}

void draw_curves(const Canvas& canvas, const Plot& plot, const PlotArea& area) {
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const bool bars = plot.curves[i].bars;
    (bars ? draw_bars : draw_band)(canvas, area, plot.curves[i], static_cast<int>(i));
  }
  // The first curve is the one that matters: it comes last, on top.
  for (std::size_t i = plot.curves.size(); i-- > 0;) {
    draw_curve(canvas, area, plot.curves[i], static_cast<int>(i));
  }
}

void draw_points(const Canvas& canvas, const Plot& plot, const PlotArea& area) {
  for (std::size_t i = plot.curves.size(); i-- > 0;) {
    draw_marks(canvas, area, plot.curves[i], static_cast<int>(i));
    draw_markers(canvas, area, plot.curves[i], static_cast<int>(i));
  }
}

void draw_all(const Canvas& canvas, const Plot& plot, const Margins& margins) {
  const PlotArea area = layout(canvas, plot, margins);
  LegendBox legend = margins.key ? LegendBox{} : legend_size(canvas, plot);
  if (margins.legends && leaves_room(legend, plot)) {
    legend.x = area.right() + kBeside / 2, legend.y = area.top - 4;
    legend.inside = false;
  } else if (legend.height > 0) {
    std::size_t hidden = 0;
    legend = place_legend(legend, plot, area, hidden);
  }
  canvas.clear();
  draw_grid(canvas, area);
  if (plot.zero_line) draw_zero_line(canvas, area);
  draw_curves(canvas, plot, area);
  draw_frame_and_ticks(canvas, area);
  if (range_of(plot).x.empty()) {
    canvas.text(area.left + area.width / 2, area.top + area.height / 2, "no data",
                {16, palette::muted, false, Align::centre});
  }
  draw_points(canvas, plot, area);  // whole, also on the frame
  draw_titles(canvas, plot, area);
  draw_legend_box(canvas, legend, plot);
}

void check_size(int width, int height) {
  if (width < 100 || height < 100 || width > 10000 || height > 10000) {
    throw InputError("a plot must be 100 .. 10000 wide and high, not " + std::to_string(width) +
                     " x " + std::to_string(height));
  }
}

// Where each plot of a page lies, and the page's own size.
constexpr int kTitleHeight = 44;  // height, of one line
struct PageLayout {
  std::vector<std::string> title;
  struct At {
    int x = 0, y = 0;
  };
  std::vector<At> at;
  int width = 0, height = 0;
};

PageLayout layout(const Canvas& ruler, const PlotPage& page) {
  PageLayout out;
  const auto columns = static_cast<std::size_t>(std::max(1, page.columns));
  int x = 0, row = 0;
  for (std::size_t i = 0; i < page.plots.size(); ++i) {
    x = i % columns == 0 ? page.plots[i].width : x + page.plots[i].width;
    out.width = std::max(out.width, x);
  }
  out.title = title_lines(ruler, page.title, out.width);
  if (!out.title.empty()) out.height = kTitleHeight + static_cast<int>(further_lines(out.title));
  x = 0;
  for (std::size_t i = 0; i < page.plots.size(); ++i) {
    if (i > 0 && i % columns == 0) out.height += row, x = row = 0;
    out.at.push_back({x, out.height});
    x += page.plots[i].width, row = std::max(row, page.plots[i].height);
  }
  out.height += row;
  return out;
}

}  // namespace

void draw_plots(const PlotPage& given, const std::string& file, const FigureStyle& style) {
  const PictureFormat format = format_of(file);
  for (const Plot& plot : given.plots) check_size(plot.width, plot.height);
  const PlotPage page = fitted(given, style);
  const Canvas ruler = Canvas::raster(8, 8);
  const PageLayout places = layout(ruler, page);
  check_size(places.width, places.height);
  const double width = style.on_paper() ? paper_width(style) : places.width;
  const Margins margins = margins_of(ruler, page, style);
  const PageKey key = margins.key ? page_key(ruler, page, width) : PageKey{};
  Canvas canvas = Canvas::page(format, width, places.height + key.height, style.on_paper());
  draw_title(canvas, places.title, width / 2, 30);
  draw_page_key(canvas, key, places.height);
  for (std::size_t i = 0; i < page.plots.size(); ++i) {
    const Plot& plot = page.plots[i];
    const Saved saved(canvas);
    cairo_translate(canvas.get(), places.at[i].x, places.at[i].y);
    cairo_rectangle(canvas.get(), 0, 0, plot.width, plot.height);
    cairo_clip(canvas.get());
    draw_all(canvas, plot, margins);
  }
  write_atomically(file, canvas.encoded());
}

void draw_plot(const Plot& plot, const std::string& file, const FigureStyle& style) {
  draw_plots({{plot}, 1}, file, style);
}

}  // namespace lilytank
