#include <algorithm>
#include <array>
#include <cmath>

#include "palette.hpp"
#include "plot_area.hpp"

namespace lilytank {
namespace {

constexpr double kLine = 2.2, kMarker = 4.2;  // units
constexpr double kCap = 4.5, kMark = 6;       // half widths of bars' ends, half heights of marks

// The lightest end of the scale would not be seen on paper.
Colour colour_of(const Curve& curve, int index) {
  constexpr double kLightest = 0.88;
  if (std::isnan(curve.shade)) return colour_of_curve(index);
  return colour_on(ColourScale::rising, kLightest * std::clamp(curve.shade, 0.0, 1.0));
}

// After one round of colours the dashes change, so that curves stay apart in print.
void set_dashes(const Canvas& canvas, const Curve& curve, int index) {
  if (!std::isnan(curve.shade)) return;
  static constexpr std::array<std::array<double, 4>, 4> kDashes = {
      {{0, 0, 0, 0}, {9, 5, 9, 5}, {2.2, 4, 2.2, 4}, {10, 4, 2.2, 4}}};
  const auto& d = kDashes[static_cast<std::size_t>(index / 6) % kDashes.size()];
  cairo_set_dash(canvas.get(), d.data(), d[0] > 0 ? 4 : 0, 0);
}

void marker_path(const Canvas& canvas, const Curve& curve, int index, double x, double y) {
  cairo_t* c = canvas.get();
  const double r = kMarker;
  switch (std::isnan(curve.shade) ? index % 4 : 0) {
    case 0:
      canvas.circle(x, y, r);
      break;
    case 1:
      cairo_rectangle(c, x - 0.88 * r, y - 0.88 * r, 1.76 * r, 1.76 * r);
      break;
    case 2:
      cairo_move_to(c, x, y - 1.2 * r);
      cairo_line_to(c, x + 1.1 * r, y + 0.8 * r);
      cairo_line_to(c, x - 1.1 * r, y + 0.8 * r);
      cairo_close_path(c);
      break;
    default:
      cairo_move_to(c, x, y - 1.25 * r);
      cairo_line_to(c, x + 1.25 * r, y);
      cairo_line_to(c, x, y + 1.25 * r);
      cairo_line_to(c, x - 1.25 * r, y);
      cairo_close_path(c);
  }
}

// A line that leaves out points nearer than a fifth of a unit to the one before, as no eye or
// printer distinguishes them: curves of a million points stay drawable.
class Pen {
 public:
  Pen(const Canvas& canvas, bool steps) : c_(canvas.get()), steps_(steps) {}

  void to(const PagePoint& p) {
    if (!p.known()) {
      lift();
      return;
    }
    if (!down_) {
      cairo_move_to(c_, p.x, p.y);
      first_ = drawn_ = p;
      down_ = true, pieces_ = 0;
    } else if (std::fabs(p.x - drawn_.x) + std::fabs(p.y - drawn_.y) > 0.2) {
      if (steps_) cairo_line_to(c_, p.x, drawn_.y);
      cairo_line_to(c_, p.x, p.y);
      drawn_ = p;
      ++pieces_;
    }
  }
  // A point between two gaps has no line: it becomes a dot, half a line width to each side.
  void lift() {
    if (down_ && pieces_ == 0) {
      cairo_move_to(c_, first_.x - 0.01, first_.y);
      cairo_line_to(c_, first_.x + 0.01, first_.y);
    }
    down_ = false;
  }

 private:
  cairo_t* c_;
  bool steps_, down_ = false;
  PagePoint first_, drawn_;
  int pieces_ = 0;
};

// One unbroken piece of a band.
void band_piece(const Canvas& canvas, const std::vector<PagePoint>& low,
                const std::vector<PagePoint>& high, bool steps) {
  if (low.empty()) return;
  cairo_t* c = canvas.get();
  const auto line = [&](const PagePoint& from, const PagePoint& to, bool back) {
    if (steps) cairo_line_to(c, back ? from.x : to.x, back ? to.y : from.y);
    cairo_line_to(c, to.x, to.y);
  };
  cairo_move_to(c, low[0].x, low[0].y);
  for (std::size_t i = 1; i < low.size(); ++i) line(low[i - 1], low[i], false);
  cairo_line_to(c, high.back().x, high.back().y);
  for (std::size_t i = high.size() - 1; i-- > 0;) line(high[i + 1], high[i], true);
  cairo_close_path(c);
}

}  // namespace

std::size_t points_of(const Curve& curve) {
  return std::min(curve.x.size(), curve.y.size());
}

PagePoint page_point(const PlotArea& area, double x, double y) {
  if (!std::isfinite(x) || !std::isfinite(y)) return {NAN, NAN};
  return {area.at_x(x), area.at_y(y)};
}

void draw_band(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index) {
  const std::size_t n = std::min({curve.x.size(), curve.low.size(), curve.high.size()});
  const Saved saved(canvas);
  cairo_rectangle(canvas.get(), area.left, area.top, area.width, area.height);
  cairo_clip(canvas.get());
  std::vector<PagePoint> low, high;
  for (std::size_t i = 0; i <= n; ++i) {
    PagePoint l{NAN, NAN}, h{NAN, NAN};
    if (i < n) {
      h = page_point(area, curve.x[i], curve.high[i]);
      l = page_point(area, curve.x[i], curve.low[i]);
      // On a log axis a band may reach below zero: it then goes down to the axis' end.
      if (h.known() && !l.known() && std::isfinite(curve.low[i])) l = {h.x, area.bottom() + 10};
    }
    if (l.known() && h.known()) {
      low.push_back(l), high.push_back(h);
    } else {
      band_piece(canvas, low, high, curve.steps);
      low.clear(), high.clear();
    }
  }
  canvas.fill(faded(colour_of(curve, index), 0.18));
}

void draw_bars(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index) {
  const std::size_t n = std::min({curve.x.size(), curve.low.size(), curve.high.size()});
  const Saved saved(canvas);
  cairo_rectangle(canvas.get(), area.left - kCap - 1, area.top - 1, area.width + 2 * kCap + 2,
                  area.height + 2);
  cairo_clip(canvas.get());
  for (std::size_t i = 0; i < n; ++i) {
    const PagePoint low = page_point(area, curve.x[i], curve.low[i]);
    const PagePoint high = page_point(area, curve.x[i], curve.high[i]);
    if (!high.known() || !std::isfinite(curve.low[i])) continue;
    const bool cut = !low.known();  // a log axis does not reach down to it
    const double bottom = cut ? area.bottom() + 10 : low.y;
    const Colour colour = colour_of(curve, index);
    canvas.line(high.x, bottom, high.x, high.y, colour, 1.5);
    canvas.line(high.x - kCap, high.y, high.x + kCap, high.y, colour, 1.5);
    if (!cut) canvas.line(low.x - kCap, low.y, low.x + kCap, low.y, colour, 1.5);
  }
}

void draw_curve(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index) {
  if (!curve.line) return;
  const Saved saved(canvas);
  const std::size_t n = points_of(curve);
  cairo_rectangle(canvas.get(), area.left - 1, area.top - 1, area.width + 2, area.height + 2);
  cairo_clip(canvas.get());
  cairo_set_line_cap(canvas.get(), CAIRO_LINE_CAP_ROUND);
  if (curve.steps) cairo_set_line_join(canvas.get(), CAIRO_LINE_JOIN_MITER);
  Pen pen(canvas, curve.steps);
  for (std::size_t i = 0; i < n; ++i) pen.to(page_point(area, curve.x[i], curve.y[i]));
  pen.lift();
  set_dashes(canvas, curve, index);
  canvas.stroke(colour_of(curve, index), kLine);
}

void draw_marks(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index) {
  const std::size_t n = points_of(curve);
  double drawn = -1e9;
  for (const double mark : curve.marks) {
    // The last point at or before it; x rises.
    const auto end = curve.x.begin() + static_cast<std::ptrdiff_t>(n);
    const auto after =
        static_cast<std::size_t>(std::upper_bound(curve.x.begin(), end, mark) - curve.x.begin());
    if (after == 0 || (after == n && mark > curve.x[n - 1])) continue;
    double y = curve.y[after - 1];
    if (!curve.steps && after < n) {
      const double w = (mark - curve.x[after - 1]) / (curve.x[after] - curve.x[after - 1]);
      y += w * (curve.y[after] - y);
    }
    const PagePoint p = page_point(area, mark, y);
    if (!p.known() || !area.holds(p) || std::fabs(p.x - drawn) < 2) continue;
    canvas.line(p.x, p.y - kMark, p.x, p.y + kMark, colour_of(curve, index), 1.5);
    drawn = p.x;
  }
}

void draw_markers(const Canvas& canvas, const PlotArea& area, const Curve& curve, int index) {
  const std::size_t n = points_of(curve);
  if (!curve.markers && n != 1) return;  // a lone point is nothing but its marker
  PagePoint before{NAN, NAN};
  for (std::size_t i = 0; i < n; ++i) {
    const PagePoint p = page_point(area, curve.x[i], curve.y[i]);
    if (!p.known() || !area.holds(p)) continue;
    // Crowded points on a line share a marker; without one each is a datum to be counted.
    const bool crowded =
        before.known() && std::hypot(p.x - before.x, p.y - before.y) < 1.2 * kMarker;
    if (curve.line && crowded) continue;
    marker_path(canvas, curve, index, p.x, p.y);
    before = p;
  }
  canvas.fill_keep(mixed(colour_of(curve, index), palette::paper, 0.72));
  canvas.stroke(colour_of(curve, index), 1.5);
}

void draw_sample(const Canvas& canvas, const Curve& curve, int index, double x, double y,
                 double width) {
  const Saved saved(canvas);
  if (!curve.bars && !curve.low.empty() && !curve.high.empty()) {
    cairo_rectangle(canvas.get(), x, y - 6, width, 12);
    canvas.fill(faded(colour_of(curve, index), 0.18));
  }
  set_dashes(canvas, curve, index);
  if (curve.line) canvas.line(x, y, x + width, y, colour_of(curve, index), kLine);
  cairo_set_dash(canvas.get(), nullptr, 0, 0);
  if (!curve.markers) return;
  marker_path(canvas, curve, index, x + width / 2, y);
  canvas.fill_keep(mixed(colour_of(curve, index), palette::paper, 0.72));
  canvas.stroke(colour_of(curve, index), 1.5);
}

}  // namespace lilytank
