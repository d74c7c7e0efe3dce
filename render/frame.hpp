// One picture of a stored run: the tank on the left, the panel on the right.
#pragma once
#include "bodies.hpp"
#include "canvas.hpp"
#include "lilytank/render.hpp"
#include "panel.hpp"
#include "tank.hpp"

namespace lilytank {

/// Draws frames of one run. Everything that does not move can be drawn once and kept.
class FramePainter {
 public:
  /// `run` must outlive the painter. `speed`: simulated seconds per second of film, 0: a still.
  /// Throws InputError for a style out of bounds or a run without frames.
  FramePainter(const StoredRun& run, const FrameStyle& style, double speed);

  /// Background, tank, flow, captions and legend.
  void draw_static(const Canvas& canvas) const;
  /// Bodies, trails, clock and counters at a time (s). Throws InputError outside the run.
  void draw_moving(const Canvas& canvas, double time);

 private:
  const StoredRun& run_;
  FrameStyle style_;
  View view_;
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
  int width_, height_;
  FramePainter painter_;
  Canvas background_, page_;
};

/// Pixels across for a height: 16/9 of it, to the nearest even number.
int width_for(int height);

}  // namespace lilytank
