#include "map_panel.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "axes.hpp"
#include "palette.hpp"
#include "statistics/median.hpp"

namespace lilytank {
namespace {

constexpr Colour kNoData{0.925, 0.933, 0.941};
const TextStyle kMapTickText{13, palette::ink, false, Align::centre};
constexpr double kBarGap = 16, kBarWidth = 16;  // units

double value_at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : NAN;
}

// From metres to units.
class PanelView {
 public:
  PanelView(const MapPanel& panel, const PanelPlace& place)
      : place_(place), scale_(place.size / (2 * panel.extent)), extent_(panel.extent) {}
  double x(double metres) const { return place_.left + scale_ * (metres + extent_); }
  double y(double metres) const { return place_.bottom() - scale_ * (metres + extent_); }
  double length(double metres) const { return scale_ * metres; }

 private:
  PanelPlace place_;
  double scale_, extent_;
};

std::uint32_t pixel_of(const Colour& c) {
  const auto byte = [](double v) { return static_cast<std::uint32_t>(std::lround(255 * v)); };
  return 255u << 24 | byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

Colour cell_colour(const MapPanel& panel, const ColourRange& range, double value) {
  if (!panel.classes.empty()) return colour_of_class(static_cast<int>(value));
  return colour_on(panel.scale, range.share(value));
}

// The cells as one picture, several pixels a cell: without seams, and sharp in every viewer.
void draw_cells(const Canvas& canvas, const MapPanel& panel, const PanelPlace& place) {
  const int pixels = std::max(1, static_cast<int>(2 * place.size) / panel.cells);
  const int side = pixels * panel.cells;
  const ColourRange range = colour_range(panel);
  cairo_surface_t* picture = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, side, side);
  unsigned char* data = cairo_image_surface_get_data(picture);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(picture));
  std::vector<std::uint32_t> row(static_cast<std::size_t>(side));
  for (int iy = 0; data != nullptr && iy < panel.cells; ++iy) {
    for (int ix = 0; ix < panel.cells; ++ix) {
      const double v = value_at(panel.values, static_cast<std::size_t>(iy * panel.cells + ix));
      const std::uint32_t pixel = std::isfinite(v) ? pixel_of(cell_colour(panel, range, v)) : 0;
      std::fill_n(row.begin() + ix * pixels, pixels, pixel);
    }
    const int top = (panel.cells - 1 - iy) * pixels;
    for (int k = 0; k < pixels; ++k) {
      std::memcpy(data + stride * static_cast<std::size_t>(top + k), row.data(), 4 * row.size());
    }
  }
  cairo_surface_mark_dirty(picture);
  const Saved saved(canvas);
  cairo_t* c = canvas.get();
  cairo_translate(c, place.left, place.top);
  cairo_scale(c, place.size / side, place.size / side);
  cairo_set_source_surface(c, picture, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(c), CAIRO_FILTER_NEAREST);
  cairo_rectangle(c, 0, 0, side, side);
  cairo_fill(c);
  cairo_surface_destroy(picture);
}

// Strokes the path in ink with a pale seam, which shows on dark and on light cells.
void stroke_on_any(const Canvas& canvas, double width, double opacity) {
  cairo_path_t* path = cairo_copy_path(canvas.get());
  canvas.stroke(faded(palette::paper, opacity), width + 1.4);
  cairo_append_path(canvas.get(), path);
  cairo_path_destroy(path);
  canvas.stroke(faded(palette::ink, std::min(1.0, opacity + 0.2)), width);
}

// Oblique lines over a square whose lower left is (left, bottom).
void hatch_lines(const Canvas& canvas, double left, double bottom, double size) {
  for (double d = 0; d < 2 * size; d += 5) {
    cairo_move_to(canvas.get(), left + d - size, bottom);
    cairo_line_to(canvas.get(), left + d, bottom - size);
  }
  stroke_on_any(canvas, 0.7, 0.6);
}

void hatch(const Canvas& canvas, const MapPanel& panel, const PanelPlace& place) {
  const std::size_t n = std::min(panel.hatched.size(), panel.values.size());
  const double h = place.size / panel.cells;
  bool any = false;
  const Saved saved(canvas);
  for (std::size_t i = 0; i < n; ++i) {
    if (!panel.hatched[i]) continue;
    const auto ix = static_cast<int>(i) % panel.cells, iy = static_cast<int>(i) / panel.cells;
    cairo_rectangle(canvas.get(), place.left + ix * h, place.bottom() - (iy + 1) * h, h, h);
    any = true;
  }
  if (!any) return;
  cairo_clip(canvas.get());
  hatch_lines(canvas, place.left, place.bottom(), place.size);
}

struct Arrow {
  double x, y, vx, vy;  // m, and the vector's unit
};

// Means over blocks of cells, so that arrows stay apart.
std::vector<Arrow> arrows_of(const MapPanel& panel, int block) {
  std::vector<Arrow> arrows;
  const double h = 2 * panel.extent / panel.cells;
  for (int by = 0; by < panel.cells; by += block) {
    for (int bx = 0; bx < panel.cells; bx += block) {
      Arrow sum{0, 0, 0, 0};
      int n = 0;
      for (int k = 0; k < block * block; ++k) {
        const int ix = bx + k % block, iy = by + k / block;
        if (ix >= panel.cells || iy >= panel.cells) continue;
        const auto i = static_cast<std::size_t>(iy * panel.cells + ix);
        const double vx = value_at(panel.arrow_x, i), vy = value_at(panel.arrow_y, i);
        if (!std::isfinite(vx) || !std::isfinite(vy)) continue;
        sum.x += (ix + 0.5) * h - panel.extent, sum.y += (iy + 0.5) * h - panel.extent;
        sum.vx += vx, sum.vy += vy;
        ++n;
      }
      if (2 * n >= block * block) arrows.push_back({sum.x / n, sum.y / n, sum.vx / n, sum.vy / n});
    }
  }
  return arrows;
}

// The length that 19 of 20 arrows do not exceed: a wild cell must not shrink all others.
double usual_most(const std::vector<Arrow>& arrows) {
  std::vector<double> lengths;
  for (const Arrow& a : arrows) lengths.push_back(std::hypot(a.vx, a.vy));
  if (lengths.empty()) return 0;
  const auto rank = static_cast<std::size_t>(0.95 * (lengths.size() - 1.0));
  return ranked(std::move(lengths), rank);
}

void arrow_line(const Canvas& canvas, double x0, double y0, double x1, double y1) {
  const double length = std::hypot(x1 - x0, y1 - y0);
  if (length < 0.5) return;
  const double head = std::min(4.5, 0.5 * length), ux = (x1 - x0) / length, uy = (y1 - y0) / length;
  cairo_t* c = canvas.get();
  cairo_move_to(c, x0, y0);
  cairo_line_to(c, x1, y1);
  cairo_move_to(c, x1 - head * (ux - 0.5 * uy), y1 - head * (uy + 0.5 * ux));
  cairo_line_to(c, x1, y1);
  cairo_line_to(c, x1 - head * (ux + 0.5 * uy), y1 - head * (uy - 0.5 * ux));
}

// 1, 2 or 5 times a power of ten, at most `value`.
double round_below(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  return (value >= 5 * power ? 5 : value >= 2 * power ? 2 : 1) * power;
}

void draw_arrows(const Canvas& canvas, const MapPanel& panel, const PanelPlace& place) {
  if (panel.arrow_x.empty()) return;
  const PanelView view(panel, place);
  const int block = std::max(1, (panel.cells + 24) / 25);
  const std::vector<Arrow> arrows = arrows_of(panel, block);
  const double peak = usual_most(arrows);
  if (!(peak > 0)) return;
  const double unit = 1.5 * block * place.size / panel.cells / peak;  // units per m/s
  for (const Arrow& a : arrows) {
    const double x = view.x(a.x), y = view.y(a.y), dx = unit * a.vx / 2, dy = unit * a.vy / 2;
    arrow_line(canvas, x - dx, y + dy, x + dx, y - dy);
  }
  cairo_set_line_cap(canvas.get(), CAIRO_LINE_CAP_ROUND);
  stroke_on_any(canvas, 1.1, 0.8);
  const double shown = round_below(peak);
  const double y = place.top - 8, x1 = place.right(), x0 = x1 - unit * shown;
  arrow_line(canvas, x0, y, x1, y);
  canvas.stroke(palette::ink, 1.1);
  canvas.text(x0 - 6, y + 4,
              number(shown, shown < 1 ? (shown < 0.1 ? 2 : 1) : 0) + " " + panel.arrow_unit,
              {12, palette::ink, false, Align::right});
}

void draw_axes(const Canvas& canvas, const MapPanel& panel, const PanelPlace& place) {
  constexpr double kTick = 5;
  const double cm = 100 * panel.extent;
  constexpr double kEvery = 50;  // units from a number to the next, at least
  const int numbers = std::min(5, static_cast<int>(place.size / kEvery));
  const Axis axis = make_axis(-cm, cm, false, numbers, true);
  cairo_rectangle(canvas.get(), place.left, place.top, place.size, place.size);
  canvas.stroke(palette::ink, 1.1);
  TextStyle right = kMapTickText;
  right.align = Align::right;
  for (const AxisTick& t : axis.ticks) {
    const double k = place.size * axis.share(t.value);
    if (!t.major || !(k >= -0.5 && k <= place.size + 0.5)) continue;
    const double x = place.left + k, y = place.bottom() - k;
    canvas.line(x, place.bottom(), x, place.bottom() + kTick, palette::ink, 1.1);
    canvas.line(place.left - kTick, y, place.left, y, palette::ink, 1.1);
    canvas.text(x, place.bottom() + 20, t.label, kMapTickText);
    if (place.y_numbers) canvas.text(place.left - 9, y + 4.5, t.label, right);
  }
  const TextStyle label{14, palette::ink, false, Align::centre};
  canvas.text(place.left + place.size / 2, place.bottom() + 40, "x (cm)", label);
  if (!place.y_numbers) return;
  canvas.upright_text(place.left - 40, place.top + place.size / 2, "y (cm)", label);
}

// The point at an end of a colour bar which says that there are values beyond.
void draw_beyond(const Canvas& canvas, double x, double y, int way, const Colour& colour) {
  cairo_move_to(canvas.get(), x, y);
  cairo_line_to(canvas.get(), x + kBarWidth / 2, y + way * 11);
  cairo_line_to(canvas.get(), x + kBarWidth, y);
  cairo_close_path(canvas.get());
  canvas.fill_keep(colour);
  canvas.stroke(palette::ink, 1.1);
}

void draw_bar(const Canvas& canvas, const MapPanel& panel, const PanelPlace& place) {
  const ColourRange range = colour_range(panel);
  const double x = place.right() + kBarGap;
  cairo_pattern_t* bar = cairo_pattern_create_linear(0, place.bottom(), 0, place.top);
  for (int i = 0; i <= 32; ++i) {
    const Colour c = colour_on(panel.scale, i / 32.0);
    cairo_pattern_add_color_stop_rgb(bar, i / 32.0, c.r, c.g, c.b);
  }
  cairo_rectangle(canvas.get(), x, place.top, kBarWidth, place.size);
  cairo_set_source(canvas.get(), bar);
  cairo_fill(canvas.get());
  cairo_pattern_destroy(bar);
  cairo_rectangle(canvas.get(), x, place.top, kBarWidth, place.size);
  canvas.stroke(palette::ink, 1.1);
  if (range.cut_high) draw_beyond(canvas, x, place.top, -1, colour_on(panel.scale, 1));
  if (range.cut_low) draw_beyond(canvas, x, place.bottom(), 1, colour_on(panel.scale, 0));
  const Axis axis = make_axis(range.low, range.high, false, 6, false);
  double widest = 0;
  const TextStyle text{13, palette::ink, false, Align::left};
  for (const AxisTick& t : axis.ticks) {
    if (!t.major) continue;
    const double y = place.bottom() - place.size * axis.share(t.value);
    canvas.line(x + kBarWidth - 4, y, x + kBarWidth, y, palette::ink, 1.1);
    canvas.text(x + kBarWidth + 6, y + 4.5, t.label, text);
    widest = std::max(widest, canvas.width_of(t.label, text));
  }
  if (!axis.note.empty()) canvas.text(x, place.top - 16, axis.note, {12, palette::muted});
  const TextStyle label{14, palette::ink, false, Align::centre};
  canvas.upright_text(x + kBarWidth + 12 + widest + 12, place.top + place.size / 2,
                      canvas.fitted(panel.label, place.size, label), label);
}

void draw_classes(const Canvas& canvas, const MapPanel& panel, const PanelPlace& place) {
  const double x = place.right() + kBarGap;
  double y = place.top + 4;
  canvas.text(x, y + 8, canvas.fitted(panel.label, 130, {13, palette::ink}), {13, palette::ink});
  const auto entry = [&](const Colour& colour, const std::string& name) {
    y += 24;
    cairo_rectangle(canvas.get(), x, y, kBarWidth, 14);
    canvas.fill_keep(colour);
    canvas.stroke(palette::rim_line, 1);
    const TextStyle text{13, palette::ink, false, Align::left};
    canvas.text(x + kBarWidth + 7, y + 12, canvas.fitted(name, 110, text), text);
  };
  for (std::size_t i = 0; i < panel.classes.size(); ++i) {
    entry(colour_of_class(static_cast<int>(i)), panel.classes[i]);
  }
  if (!panel.no_data.empty()) entry(kNoData, panel.no_data);
}

}  // namespace

ColourRange colour_range(const MapPanel& panel) {
  Range data;
  for (const double v : panel.values) data.add(v, false);
  ColourRange range;
  if (panel.low < panel.high) {
    range = {panel.low, panel.high};
  } else if (!data.empty()) {
    range = {data.low(), data.high()};
    if (panel.scale == ColourScale::diverging) {
      range.high = std::max(std::fabs(data.low()), std::fabs(data.high()));
      range.low = -range.high;
    }
  }
  if (!(range.low < range.high)) range.low -= 0.5, range.high += 0.5;
  range.cut_low = !data.empty() && data.low() < range.low;
  range.cut_high = !data.empty() && data.high() > range.high;
  return range;
}

void draw_panel(const Canvas& canvas, const MapPanel& panel, double tank_radius,
                const PanelPlace& place) {
  const PanelView view(panel, place);
  const double x = view.x(0), y = view.y(0), r = view.length(tank_radius);
  {
    const Saved saved(canvas);
    cairo_rectangle(canvas.get(), place.left, place.top, place.size, place.size);
    cairo_clip(canvas.get());
    if (tank_radius > 0) {
      canvas.circle(x, y, r);
      canvas.fill(kNoData);
    }
    draw_cells(canvas, panel, place);
    hatch(canvas, panel, place);
    if (tank_radius > 0) {
      canvas.circle(x, y, r);
      canvas.stroke(palette::ink, 1.3);
    }
    for (const MapPanel::Ring& ring : panel.rings) {
      canvas.circle(view.x(ring.x), view.y(ring.y), view.length(ring.radius));
      stroke_on_any(canvas, 1.6, 0.8);
    }
  }
  draw_arrows(canvas, panel, place);
  draw_axes(canvas, panel, place);
  const TextStyle title{15, palette::ink, true, Align::left};
  const double room = panel.arrow_x.empty() ? place.size + place.beside : place.size - 110;
  canvas.text(place.left, place.top - 10, canvas.fitted(panel.title, room, title), title);
}

void draw_scale(const Canvas& canvas, const MapPanel& panel, const PanelPlace& place) {
  (panel.classes.empty() ? draw_bar : draw_classes)(canvas, panel, place);
}

void draw_hatching_key(const Canvas& canvas, const std::string& meaning, double x, double y) {
  constexpr double kWidth = 26, kHeight = 16;
  {
    const Saved saved(canvas);
    cairo_rectangle(canvas.get(), x, y - kHeight, kWidth, kHeight);
    cairo_clip_preserve(canvas.get());
    canvas.fill(kNoData);
    hatch_lines(canvas, x, y, kWidth);
  }
  cairo_rectangle(canvas.get(), x, y - kHeight, kWidth, kHeight);
  canvas.stroke(palette::rim_line, 1);
  canvas.text(x + kWidth + 9, y - 3, meaning, {14, palette::ink, false, Align::left});
}

bool same_scale(const MapPanel& a, const MapPanel& b) {
  const ColourRange p = colour_range(a), q = colour_range(b);
  return a.scale == b.scale && a.label == b.label && a.classes == b.classes &&
         a.no_data == b.no_data &&
         (!a.classes.empty() ||
          (std::equal_to<double>()(p.low, q.low) && std::equal_to<double>()(p.high, q.high)));
}

}  // namespace lilytank
