// Modules: round-cornered squares with labels, faces and bonds; all bodies and trails of a stored
// run at one time.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "canvas.hpp"
#include "poses.hpp"
#include "tank.hpp"

namespace lilytank {

/// How a face is drawn: a pale dash, a notch, half of an open ring, half of a bridge.
enum class FaceLook { off, free, latched, bonded };

/// Where a module is on the page: centre (units), counter-clockwise angle (rad), side (units).
struct ModulePlace {
  double x = 0, y = 0, theta = 0, side = 1;
};

/// What a drawn module shows besides its pose.
struct ModuleLook {
  Colour fill;
  std::string label;      ///< in the middle, upright; may be empty
  double least_text = 0;  ///< units, of the label; without room for it there is none
  int last = -1;          ///< the face that was engaged last, -1: none
  std::array<FaceLook, 4> faces{FaceLook::free, FaceLook::free, FaceLook::free, FaceLook::free};
};

/// The body's colour in a control state: paler where it is not part of a finished copy.
Colour colour_of_module(int state, bool complete);
/// Adds the outline of a module to the path.
void module_path(const Canvas& canvas, const ModulePlace& place);
/// The outline that marks finished copies, around the modules in the path, which it forgets. To be
/// drawn before the modules themselves.
void draw_halo(const Canvas& canvas);
/// The body, exactly `side` wide.
void draw_module(const Canvas& canvas, const ModulePlace& place, const ModuleLook& look);
/// Faces, bonds and label; to be drawn after all bodies, as bonds reach to the neighbour.
void draw_connectors(const Canvas& canvas, const ModulePlace& place, const ModuleLook& look);

/// Draws the bodies of a run; keeps scratch memory, so that a film does not allocate.
class BodyPainter {
 public:
  /// `model` must outlive the painter. `labels`: see FrameStyle. `least_text`: of labels, units.
  BodyPainter(const Model& model, const View& view, bool labels, double least_text = 0);

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
  double least_text_;
  std::vector<TrailPoint> trail_;
  Snapshot start_;
};

}  // namespace lilytank
