#include "frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/atomic_file.hpp"
#include "page_fit.hpp"
#include "palette.hpp"
#include "text/number.hpp"
#include "text/words.hpp"
#include "view/streamlines.hpp"

namespace lilytank {
namespace {

constexpr Panel::Box kPanel{1130, 40, 730, 1000};

const FrameStyle& checked(const FrameStyle& style, const StoredRun& run) {
  if (style.size < 120 || style.size > 8640) {
    throw InputError("the picture's height must be 120 .. 8640 pixels, not " +
                     std::to_string(style.size));
  }
  if (!(style.trail >= 0)) throw InputError("the trail's length must be 0 s or more");
  const Trajectory& t = run.trajectory;
  check_time(t, t.time.empty() ? 0 : t.time.back());
  return style;
}

}  // namespace

int width_for(int height) {
  return 2 * static_cast<int>(std::lround(height * 8.0 / 9.0));
}

FramePainter::FramePainter(const StoredRun& run, const FrameStyle& style, double speed,
                           double least_text)
    : run_(run),
      style_(checked(style, run)),
      view_(view_of_tank(run.scenario.model.tank.radius)),
      pumps_(run),
      least_text_(least_text),
      panel_(run, style, kPanel, speed),
      bodies_(run.scenario.model, view_, style.labels, least_text) {}

void FramePainter::draw_static(const Canvas& canvas, int field) const {
  canvas.clear();
  draw_tank(canvas, view_, run_.scenario.model, style_.flow, field);
  draw_scale_bar(canvas, view_, run_.scenario.model, 60, 1036, least_text_);
  if (style_.panel) panel_.draw_static(canvas, field, pumps_.power_of(field));
}

void FramePainter::draw_moving(const Canvas& canvas, double time) {
  check_time(run_.trajectory, time);
  interpolate(run_.trajectory, run_.scenario.model.module.side, time, now_);
  bodies_.trails(canvas, run_.trajectory, now_, style_.trail);
  bodies_.bodies(canvas, now_);
  if (style_.panel) panel_.draw_moving(canvas, now_);
}

FrameRaster::FrameRaster(const StoredRun& run, const FrameStyle& style, double speed, int height)
    : panel_(style.panel),
      width_(panel_ ? width_for(height) : height / 2 * 2),
      height_(height),
      painter_(run, style, speed),
      page_(scaled_page()) {}

Canvas FrameRaster::scaled_page() const {
  Canvas page = Canvas::raster(width_, height_);
  cairo_scale(page.get(), width_ / (panel_ ? kPageWidth : kTankPage), height_ / kPageHeight);
  if (!panel_) cairo_translate(page.get(), -kTankPageLeft, 0);
  return page;
}

// Few are kept, as each is as large as a frame; a flow that comes back later is drawn again.
const Canvas& FrameRaster::background(int field) {
  constexpr std::size_t kMost = 6;
  const auto known = backgrounds_.find(field);
  if (known != backgrounds_.end()) return known->second;
  if (backgrounds_.size() >= kMost) backgrounds_.clear();
  const Canvas& made = backgrounds_.emplace(field, scaled_page()).first->second;
  painter_.draw_static(made, field);
  return made;
}

Canvas& FrameRaster::draw(double time) {
  const auto from = background(painter_.field_at(time)).pixels(), to = page_.pixels();
  std::memcpy(to.data(), from.data(), to.size());
  cairo_surface_mark_dirty(cairo_get_target(page_.get()));
  painter_.draw_moving(page_, time);
  return page_;
}

std::string bodies_text(const StoredRun& run) {
  const int balls = run.trajectory.bodies - run.trajectory.modules;
  std::string out;
  if (run.trajectory.modules > 0) out = counted(run.trajectory.modules, "module");
  if (balls > 0) out += (out.empty() ? "" : ", ") + counted(balls, "ball");
  return out;
}

Figure frame_figure(const StoredRun& run, double time, const FrameStyle& style) {
  const Pumps pumps(run);
  Figure figure;
  std::string& out = figure.caption;
  out = "The tank seen from above at " + significant(time, 6) + " s.";
  if (run.trajectory.modules > 0) {
    out +=
        " Squares: modules in the colour of their control state (grey: 0), paler outside a "
        "completed copy, which has an orange outline.";
    if (style.labels) {
      out += " Numbers: control state; blue or white bar: connector engaged last.";
    }
  }
  if (style.trail > 0) out += " Trails: the last " + significant(style.trail, 3) + " s.";
  if (style.flow != FlowStyle::none && peak_of_all(run.scenario.model) > 0) {
    out += style.flow == FlowStyle::arrows ? " Arrows" : " Lines";
    out += ": mean flow, stronger where it is faster.";
  }
  const std::string power = pumps.power_of(pumps.field_at(time));
  if (!power.empty()) out += " Pump power: " + power + ".";
  figure.n = bodies_text(run) + " in 1 run";
  return figure;
}

std::string frame_caption(const StoredRun& run, double time, const FrameStyle& style,
                          const ReportProvenance& provenance) {
  return caption_text(frame_figure(run, time, style), provenance);
}

namespace {

// On paper: the tank alone, texts as large as those of other figures.
std::string paper_picture(const StoredRun& run, double time, FrameStyle style, PictureFormat format,
                          const FigureStyle& paper) {
  constexpr double kPaperText = 14;  // units of paper, 7 pt
  style.panel = false;
  const double width = paper_width(paper), scale = width / kTankPage;
  FramePainter painter(run, style, 0, kPaperText / scale);
  Canvas canvas = Canvas::page(format, width, width, true);
  cairo_scale(canvas.get(), scale, scale);
  cairo_translate(canvas.get(), -kTankPageLeft, 0);
  painter.draw_static(canvas, painter.field_at(time));
  painter.draw_moving(canvas, time);
  return canvas.encoded();
}

}  // namespace

std::string frame_picture(const StoredRun& run, double time, const FrameStyle& style,
                          const std::string& file, const FigureStyle& paper) {
  const PictureFormat format = format_of(file);
  check_time(run.trajectory, time);
  if (paper.on_paper()) return paper_picture(run, time, style, format, paper);
  if (format == PictureFormat::png) {
    FrameRaster raster(run, style, 0, style.size);
    return std::string(raster.draw(time).encoded());
  }
  FramePainter painter(run, style, 0);
  const double scale = style.size / kPageHeight;
  const double width = style.panel ? width_for(style.size) : style.size;
  Canvas canvas = Canvas::vector(format, width, style.size);
  cairo_scale(canvas.get(), scale, scale);
  if (!style.panel) cairo_translate(canvas.get(), -kTankPageLeft, 0);
  painter.draw_static(canvas, painter.field_at(time));
  painter.draw_moving(canvas, time);
  return std::string(canvas.encoded());
}

void draw_frame(const StoredRun& run, double time, const FrameStyle& style, const std::string& file,
                const FigureStyle& paper) {
  write_atomically(file, frame_picture(run, time, style, file, paper));
}

}  // namespace lilytank
