#include "engine.hpp"

#include <cmath>

#include "forces/force_sum.hpp"

namespace lilytank::bench {

Bodies::Bodies(int count)
    : x(count), y(count), c(count), s(count), vx(count), vy(count), omega(count), covered(count) {}

Kinematics Bodies::kinematics() const {
  return {x, y, c, s, vx, vy, omega, covered, static_cast<int>(x.size())};
}

Decay EngineSetup::decay() const {
  return total_decay(model.forces, step());
}

int wall_corners(double radius) {
  return static_cast<int>(std::lround(2 * kPi * radius / 0.015));
}

std::vector<EngineKind> engine_kinds() {
  return {
#ifdef LILYTANK_WITH_ODE
      {"ode", &make_ode},
#endif
#ifdef LILYTANK_WITH_BOX2D
      {"box2d", &make_box2d},
#endif
#ifdef LILYTANK_WITH_CHIPMUNK
      {"chipmunk", &make_chipmunk},
#endif
  };
}

}  // namespace lilytank::bench
