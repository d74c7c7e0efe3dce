#include "frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/atomic_file.hpp"
#include "palette.hpp"

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

FramePainter::FramePainter(const StoredRun& run, const FrameStyle& style, double speed)
    : run_(run),
      style_(checked(style, run)),
      view_(view_of_tank(run.scenario.model.tank.radius)),
      pumps_(run),
      panel_(run, style, kPanel, speed),
      bodies_(run.scenario.model, view_, style.labels) {}

void FramePainter::draw_static(const Canvas& canvas, int field) const {
  canvas.clear();
  draw_tank(canvas, view_, run_.scenario.model, style_.flow, field);
  draw_scale_bar(canvas, view_, run_.scenario.model, 60, 1036);
  panel_.draw_static(canvas, field, pumps_.power_of(field));
}

void FramePainter::draw_moving(const Canvas& canvas, double time) {
  check_time(run_.trajectory, time);
  interpolate(run_.trajectory, run_.scenario.model.module.side, time, now_);
  bodies_.trails(canvas, run_.trajectory, now_, style_.trail);
  bodies_.bodies(canvas, now_);
  panel_.draw_moving(canvas, now_);
}

FrameRaster::FrameRaster(const StoredRun& run, const FrameStyle& style, double speed, int height)
    : width_(width_for(height)),
      height_(height),
      painter_(run, style, speed),
      page_(scaled_page()) {}

Canvas FrameRaster::scaled_page() const {
  Canvas page = Canvas::raster(width_, height_);
  cairo_scale(page.get(), width_ / kPageWidth, height_ / kPageHeight);
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

std::string frame_picture(const StoredRun& run, double time, const FrameStyle& style,
                          const std::string& file) {
  const PictureFormat format = format_of(file, {PictureFormat::png, PictureFormat::svg});
  check_time(run.trajectory, time);
  if (format == PictureFormat::png) {
    FrameRaster raster(run, style, 0, style.size);
    return std::string(raster.draw(time).encoded());
  }
  FramePainter painter(run, style, 0);
  const double scale = style.size / kPageHeight;
  Canvas canvas = Canvas::vector(format, width_for(style.size), style.size);
  cairo_scale(canvas.get(), scale, scale);
  painter.draw_static(canvas, painter.field_at(time));
  painter.draw_moving(canvas, time);
  return std::string(canvas.encoded());
}

void draw_frame(const StoredRun& run, double time, const FrameStyle& style,
                const std::string& file) {
  write_atomically(file, frame_picture(run, time, style, file));
}

}  // namespace lilytank
