// One picture of a stored run: the tank on the left, the panel on the right.
#pragma once
#include <map>

#include "bodies.hpp"
#include "canvas.hpp"
#include "lilytank/render.hpp"
#include "panel.hpp"
#include "tank.hpp"
#include "view/pumps.hpp"

namespace lilytank {

/// Draws frames of one run. Everything that does not move can be drawn once and kept.
class FramePainter {
 public:
  /// `run` must outlive the painter. `speed`: simulated seconds per second of film, 0: a still.
  /// `least_text`: units, smallest text at the tank. Throws InputError for a style out of bounds or
  /// a run without frames.
  FramePainter(const StoredRun& run, const FrameStyle& style, double speed, double least_text = 0);

  /// Number of the flow in force at a time (s). While it stays, so does all that draw_static draws.
  int field_at(double time) const { return pumps_.field_at(time); }
  /// Background, tank, captions and legend, with a flow.
  void draw_static(const Canvas& canvas, int field) const;
  /// Bodies, trails, clock and counters at a time (s). Throws InputError outside the run.
  void draw_moving(const Canvas& canvas, double time);

 private:
  const StoredRun& run_;
  FrameStyle style_;
  View view_;
  Pumps pumps_;
  double least_text_;
  Panel panel_;
  BodyPainter bodies_;
  Snapshot now_;
};

/// A raster picture that redraws only what moves.
class FrameRaster {
 public:
  /// `height` pixels high (even for films).
  FrameRaster(const StoredRun& run, const FrameStyle& style, double speed, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  /// The frame at a time (s); valid until the next call.
  Canvas& draw(double time);

 private:
  Canvas scaled_page() const;
  const Canvas& background(int field);

  bool panel_;
  int width_, height_;
  FramePainter painter_;
  std::map<int, Canvas> backgrounds_;  // by the flow in force
  Canvas page_;
};

/// The caption of a frame, for a figure that the caller names.
Figure frame_figure(const StoredRun& run, double time, const FrameStyle& style);
/// "15 modules, 3 balls".
std::string bodies_text(const StoredRun& run);

/// Pixels across for a height: 16/9 of it, to the nearest even number.
int width_for(int height);

}  // namespace lilytank
