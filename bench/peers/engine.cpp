#include "engine.hpp"

#include <cmath>

namespace lilytank::bench {

Bodies::Bodies(int count)
    : x(count), y(count), c(count), s(count), vx(count), vy(count), omega(count), covered(count) {}

Kinematics Bodies::kinematics() const {
  return {x, y, c, s, vx, vy, omega, covered, static_cast<int>(x.size())};
}

Decay EngineSetup::decay() const {
  Decay all;
  for (const ActiveForce& force : model.forces) {
    const Decay one = force.term->decay(force.p, step());
    all.linear *= one.linear, all.angular *= one.angular;
  }
  return all;
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
