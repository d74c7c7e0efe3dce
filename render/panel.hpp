// The right third of a frame: title, clock, yield and legend.
#pragma once
#include <string>
#include <vector>

#include "canvas.hpp"
#include "lilytank/render.hpp"
#include "poses.hpp"
#include "yield.hpp"

namespace lilytank {

/// Draws the panel into the box from (x, y), `width` x `height` units.
class Panel {
 public:
  struct Box {
    double x = 0, y = 0, width = 0, height = 0;
  };
  /// `run` must outlive the panel. `speed`: simulated seconds per second of film, 0: a still.
  Panel(const StoredRun& run, const FrameStyle& style, const Box& box, double speed);

  /// Title, captions, the whole yield curve and the legend while a flow is in force
  /// (view/pumps.hpp). `power`: of the pumps, empty where it is always the same.
  void draw_static(const Canvas& canvas, int field, const std::string& power) const;
  /// Clock, counter, icons of copies and the curve's cursor.
  void draw_moving(const Canvas& canvas, const Snapshot& now) const;

 private:
  bool has_yield() const { return yield_.target_size > 0; }
  std::string subtitle() const;
  void caption(const Canvas& canvas, double y, const std::string& text) const;
  void title(const Canvas& canvas) const;
  void curve_axes(const Canvas& canvas) const;
  /// The staircase from the start to `until` (s), as a path.
  void stairs(const Canvas& canvas, double until) const;
  void icons(const Canvas& canvas, int copies) const;
  double plot_x(double time) const;
  double plot_y(double copies) const;

  const StoredRun& run_;
  FrameStyle style_;
  Box box_, plot_;
  double speed_;
  YieldCurve yield_;
  TimeUnit unit_;
  double end_ = 1;  ///< s, end of the curve's time axis
  int most_ = 1;    ///< copies, top of the curve's axis
};

/// Draws the legend of a run with its top left corner at (x, y), `width` units wide: control
/// states, faces, marks and flow, as far as they can appear on its frames. `field`: the flow in
/// force (view/pumps.hpp).
void draw_legend(const Canvas& canvas, const StoredRun& run, const FrameStyle& style, int field,
                 double x, double y, double width);
/// Its height (units).
double legend_height(const StoredRun& run, const FrameStyle& style);

}  // namespace lilytank
