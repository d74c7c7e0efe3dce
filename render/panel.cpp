#include "panel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "axes.hpp"
#include "palette.hpp"

namespace lilytank {
namespace {

// Heights of the panel's parts, units from its top.
constexpr double kTitleAt = 52, kSubtitle = 94, kRule = 122;
constexpr double kClockCaption = 164, kClock = 242;
constexpr double kYieldCaption = 306, kYield = 360;
constexpr double kPlotTop = 424;
constexpr double kPlotLeft = 46;  // room for the numbers on the left of the curve

const TextStyle kCaption{20, palette::muted, false, Align::left};

std::string speed_text(double speed) {
  if (std::fabs(speed - 1) < 0.005) return "real time";
  char text[40];
  std::snprintf(text, sizeof text, speed >= 100 ? "%.0f× real time" : "%.3g× real time", speed);
  return text;
}

}  // namespace

Panel::Panel(const StoredRun& run, const FrameStyle& style, const Box& box, double speed)
    : run_(run), style_(style), box_(box), speed_(speed), yield_(yield_of(run)) {
  end_ = run.trajectory.time.empty() ? 1 : run.trajectory.time.back();
  unit_ = unit_for(end_);
  most_ = std::max(1, yield_.possible);
  for (const int c : yield_.copies) most_ = std::max(most_, c);
  const double bottom = box.y + box.height - legend_height(run, style) - 70;
  plot_ = {box.x + kPlotLeft, box.y + kPlotTop, box.width - kPlotLeft - 14,
           bottom - box.y - kPlotTop};
}

std::string Panel::subtitle() const {
  const Model& model = run_.scenario.model;
  std::string s;
  const auto count = [&](int n, const char* one, const char* more) {
    if (n == 0) return;
    s += (s.empty() ? "" : ", ") + std::to_string(n) + " " + (n == 1 ? one : more);
  };
  count(run_.trajectory.modules, "module", "modules");
  count(run_.trajectory.bodies - run_.trajectory.modules, "ball", "balls");
  if (!model.rulesets.empty() && !model.rulesets[0].name.empty()) {
    s += " · ruleset " + model.rulesets[0].name;
  }
  return s + " · seed " + std::to_string(run_.scenario.seed);
}

void Panel::caption(const Canvas& canvas, double y, const std::string& text) const {
  canvas.text(box_.x, box_.y + y, text, kCaption);
}

void Panel::title(const Canvas& canvas) const {
  TextStyle style{36, palette::ink, true, Align::left};
  const std::string name = run_.scenario.title.empty() ? "lilytank" : run_.scenario.title;
  // A long title is set smaller, then in two lines, then cut.
  while (style.size > 28 && canvas.width_of(name, style) > box_.width) style.size -= 1;
  if (canvas.width_of(name, style) <= box_.width) {
    canvas.text(box_.x, box_.y + kTitleAt, name, style);
  } else {
    std::size_t cut = name.size();
    while (cut != std::string::npos && canvas.width_of(name.substr(0, cut), style) > box_.width) {
      cut = cut == 0 ? std::string::npos : name.rfind(' ', cut - 1);
    }
    const bool two = cut != std::string::npos && cut > 0;
    const std::string rest = two ? name.substr(cut + 1) : name;
    if (two) canvas.text(box_.x, box_.y + kTitleAt - 32, name.substr(0, cut), style);
    canvas.text(box_.x, box_.y + kTitleAt + 4, canvas.fitted(rest, box_.width, style), style);
  }
  const TextStyle small{22, palette::muted, false, Align::left};
  canvas.text(box_.x, box_.y + kSubtitle, canvas.fitted(subtitle(), box_.width, small), small);
  canvas.line(box_.x, box_.y + kRule, box_.x + box_.width, box_.y + kRule, palette::hairline, 2);
}

double Panel::plot_x(double time) const {
  const double start = run_.trajectory.time.empty() ? 0 : std::min(0.0, run_.trajectory.time[0]);
  return plot_.x + plot_.width * (time - start) / std::max(1e-9, end_ - start);
}

double Panel::plot_y(double copies) const {
  return plot_.y + plot_.height * (1 - copies / (1.08 * most_));
}

void Panel::curve_axes(const Canvas& canvas) const {
  const double left = plot_.x, right = plot_.x + plot_.width;
  for (const int copies : copy_ticks(most_)) {
    const double y = plot_y(copies);
    canvas.line(left, y, right, y, copies == 0 ? palette::muted : palette::hairline, 1.5);
    canvas.text(left - 12, y + 7, std::to_string(copies),
                {20, palette::muted, false, Align::right});
  }
  const Axis along = make_axis(0, end_ / unit_.seconds, false, 6, false);
  const double base = plot_y(0);
  for (const AxisTick& tick : along.ticks) {
    if (!tick.major) continue;
    const double x = plot_x(tick.value * unit_.seconds);
    canvas.line(x, base, x, base + 7, palette::muted, 1.5);
    canvas.text(x, base + 31, tick.label, {20, palette::muted, false, Align::centre});
  }
  canvas.text((left + right) / 2, base + 58, "time (" + unit_.name + ")",
              {20, palette::muted, false, Align::centre});
}

void Panel::stairs(const Canvas& canvas, double until) const {
  cairo_t* c = canvas.get();
  for (std::size_t i = 0; i < yield_.time.size() && yield_.time[i] <= until; ++i) {
    const double x = plot_x(yield_.time[i]);
    if (i == 0)
      cairo_move_to(c, x, plot_y(yield_.copies[0]));
    else {
      cairo_line_to(c, x, plot_y(yield_.copies[i - 1]));
      cairo_line_to(c, x, plot_y(yield_.copies[i]));
    }
  }
  if (cairo_has_current_point(c)) {
    const double end = std::min(until, yield_.time.back());
    cairo_line_to(c, plot_x(end), plot_y(yield_.at(end)));
  }
}

void Panel::icons(const Canvas& canvas, int copies) const {
  const auto& cells = run_.scenario.model.rulesets[0].target;
  Cell low = cells[0], high = cells[0];
  for (const Cell& c : cells) {
    low = {std::min(low.x, c.x), std::min(low.y, c.y)};
    high = {std::max(high.x, c.x), std::max(high.y, c.y)};
  }
  const int columns = high.x - low.x + 1, rows = high.y - low.y + 1;
  const int shown = std::min(most_, 12);
  const double room = box_.width - 300, gap = 16;
  const double side = std::min({64.0 / rows, (room / shown - gap) / columns, 20.0});
  const double wide = side * columns;
  double x = box_.x + box_.width - shown * (wide + gap) + gap;
  const double bottom = box_.y + kYield + 6 - std::max(0.0, 44 - side * rows) / 2;
  for (int k = 0; k < shown; ++k, x += wide + gap) {
    for (const Cell& c : cells) {
      canvas.rounded(x + side * (c.x - low.x) + 0.04 * side,
                     bottom - side * (c.y - low.y + 1) + 0.04 * side, 0.92 * side, 0.92 * side,
                     0.16 * side);
    }
    canvas.fill_keep(k < copies ? palette::halo : palette::paper);
    canvas.stroke(k < copies ? mixed(palette::halo, palette::ink, 0.45) : palette::rim_line, 1.6);
  }
}

void Panel::draw_static(const Canvas& canvas, int field, const std::string& power) const {
  title(canvas);
  if (!power.empty()) {
    canvas.text(box_.x + box_.width, box_.y + kClockCaption, "pump power " + power,
                {20, palette::muted, false, Align::right});
  }
  caption(canvas, kClockCaption, "time (h:mm:ss)");
  if (speed_ > 0) {
    canvas.text(box_.x + box_.width, box_.y + kClock, speed_text(speed_),
                {24, palette::muted, false, Align::right});
  }
  if (has_yield()) {
    caption(canvas, kYieldCaption, "yield");
    curve_axes(canvas);
    stairs(canvas, end_);
    canvas.stroke(palette::rim, 3);
  }
  // Without a yield the legend follows the clock.
  const double below = has_yield() ? box_.height - legend_height(run_, style_) : kYieldCaption - 14;
  draw_legend(canvas, run_, style_, field, box_.x, box_.y + below, box_.width);
}

void Panel::draw_moving(const Canvas& canvas, const Snapshot& now) const {
  canvas.text(box_.x - 4, box_.y + kClock, clock_text(now.time),
              {76, palette::ink, false, Align::left});
  if (!has_yield()) return;
  const int copies = yield_.at(now.time);
  canvas.text(box_.x, box_.y + kYield,
              std::to_string(copies) + " of " + std::to_string(yield_.possible) +
                  (yield_.possible == 1 ? " copy" : " copies"),
              {40, palette::ink, true, Align::left});
  icons(canvas, copies);
  stairs(canvas, now.time);
  canvas.stroke(palette::accent, 4);
  const double x = plot_x(now.time), y = plot_y(copies);
  canvas.line(x, plot_.y, x, plot_y(0), faded(palette::accent, 0.45), 2);
  canvas.circle(x, y, 8);
  canvas.fill_keep(palette::paper);
  canvas.stroke(palette::accent, 4);
}

}  // namespace lilytank
