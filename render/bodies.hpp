// All modules, balls and trails of a stored run at one time.
#pragma once
#include <vector>

#include "modules.hpp"
#include "poses.hpp"
#include "tank.hpp"

namespace lilytank {

/// Draws the bodies of a run; keeps scratch memory, so that a film does not allocate.
class BodyPainter {
 public:
  /// `model` must outlive the painter. `labels`: see FrameStyle.
  BodyPainter(const Model& model, const View& view, bool labels);

  /// Paths of the last `seconds` before the snapshot, fading with age.
  void trails(const Canvas& canvas, const Trajectory& trajectory, const Snapshot& now,
              double seconds);
  /// Balls, then modules with their bonds; finished copies stand out.
  void bodies(const Canvas& canvas, const Snapshot& now) const;

 private:
  struct TrailPoint {
    Vec2 at;
    double age;  // s
  };
  ModuleLook look(const Snapshot& now, int i) const;
  ModulePlace place(const BodyPose& pose) const;
  void halo(const Canvas& canvas, const Snapshot& now) const;
  void shadows(const Canvas& canvas, const Snapshot& now) const;
  void balls(const Canvas& canvas, const Snapshot& now) const;
  void collect_trail(const Trajectory& trajectory, const Snapshot& now, double seconds, int body);
  void draw_trail(const Canvas& canvas, const Colour& colour, double seconds) const;

  const Model& model_;
  View view_;
  bool labels_;
  std::vector<TrailPoint> trail_;
  Snapshot start_;
};

}  // namespace lilytank
