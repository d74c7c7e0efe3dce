// Bodies in random motion, and the wrenches that a force term puts on them.
#pragma once
#include <vector>

#include "lilytank/force.hpp"
#include "lilytank/model.hpp"
#include "lilytank/random.hpp"

namespace lilytank::test {

// Arrays that a Kinematics looks into, filled with random motion.
struct MovingBodies {
  std::vector<double> x, y, c, s, vx, vy, omega;
  std::vector<std::uint8_t> covered;
  int modules;
  MovingBodies(int modules_, int balls, std::uint64_t seed, double speed = 0.3)
      : modules(modules_) {
    for (int i = 0; i < modules_ + balls; ++i) {
      const auto u = [&](int k) {
        return 2 * uniform({seed, Stream::start_pose, i, 0, static_cast<std::uint32_t>(k)}) - 1;
      };
      const Rot r = rotation(kPi * u(2));
      x.push_back(0.2 * u(0)), y.push_back(0.2 * u(1)), c.push_back(r.c), s.push_back(r.s);
      vx.push_back(speed * u(3)), vy.push_back(speed * u(4)), omega.push_back(8 * u(5));
      covered.push_back(static_cast<std::uint8_t>(i % 3 == 2 ? 8 * (u(6) + 1) : 0));
    }
  }
  Kinematics view() const { return {x, y, c, s, vx, vy, omega, covered, modules}; }
};

inline std::vector<Wrench> wrenches(const Model& model, const MovingBodies& bodies,
                                    const ActiveForce& f, const StepContext& now) {
  std::vector<Wrench> out(bodies.x.size());
  f.term->add(model, bodies.view(), now, f.p, out);
  return out;
}

}  // namespace lilytank::test
