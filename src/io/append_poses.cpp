#include "lilytank/trajectory.hpp"

namespace lilytank {

void append_poses(const World& world, Trajectory& trajectory) {
  const Kinematics& k = world.kinematics();
  trajectory.bodies = k.size();
  trajectory.modules = k.modules;
  trajectory.time.push_back(world.time());
  for (int i = 0; i < k.size(); ++i) {
    trajectory.x.push_back(static_cast<float>(k.x[i]));
    trajectory.y.push_back(static_cast<float>(k.y[i]));
    trajectory.theta.push_back(static_cast<float>(angle_of({k.c[i], k.s[i]})));
  }
}

}  // namespace lilytank
