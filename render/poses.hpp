// Where the bodies of a stored run are at any time.
#pragma once
#include <vector>

#include "lilytank/trajectory.hpp"

namespace lilytank {

/// A body in a picture: metres, radians.
struct BodyPose {
  double x = 0, y = 0, theta = 0;
};

/// The bodies at one time.
struct Snapshot {
  double time = 0;                 ///< s
  int modules = 0;                 ///< bodies [0, modules) are squares, the rest balls
  int frame = 0;                   ///< the stored frame at or just before it
  std::vector<BodyPose> poses;     ///< [bodies]
  std::vector<Markings> marks;     ///< [modules], as in that frame; empty for recordings
  std::vector<BodyPose> next;      ///< scratch of interpolate: the frame after
  std::vector<int> group;          ///< scratch: the lowest body that moves with this one
  std::vector<std::uint8_t> held;  ///< scratch: bit f: face f keeps its neighbour
  /// Whether module i is part of a finished copy.
  bool complete(int i) const {
    return !marks.empty() && marks[static_cast<std::size_t>(i)].complete != 0;
  }
};

/// Index of the stored frame at or just before a time (the first frame for earlier times).
int frame_at(const Trajectory& trajectory, double time);
/// Sets `out` to the bodies at a time (s) between the first and the last frame: positions in a
/// straight line between stored frames, angles the shorter way round. Modules of `side` metres that
/// hold each other in both frames move as one rigid body, so that a turning chain stays a chain;
/// faces whose neighbour leaves are drawn free in between.
void interpolate(const Trajectory& trajectory, double side, double time, Snapshot& out);
/// Throws InputError unless the trajectory has frames, consistent arrays, and covers `time`.
void check_time(const Trajectory& trajectory, double time);

/// Copies of the target that stand in a stored frame: its complete modules / `target_size`.
int copies_in_frame(const Trajectory& trajectory, int frame, int target_size);

}  // namespace lilytank
