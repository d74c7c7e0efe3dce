// Bodies pushed apart: twists stay what mechanics allows, to the last bit of rounding.
#include "support/reference/island.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/samples.hpp"
#include "support/worlds.hpp"

namespace lilytank::test {
namespace {

using reference::ContactPair;
using reference::Island;
using reference::Mover;

struct Momenta {
  double x = 0, y = 0, spin = 0, energy = 0;
};

Momenta momenta(const Island& island) {
  Momenta out;
  for (const Mover& m : island.movers()) {
    if (m.mass == 0) continue;
    const Twist& t = m.twist;
    out.x += m.mass * t.vx, out.y += m.mass * t.vy;
    out.spin += m.mass * (m.pose.x * t.vy - m.pose.y * t.vx) + m.inertia * t.omega;
    out.energy += m.mass * (t.vx * t.vx + t.vy * t.vy) + m.inertia * t.omega * t.omega;
  }
  return out;
}

// A square of the given mass in an orbit with angular speed `omega` about the tank's centre that
// drifts: every part of a rigid body moves so.
void add_square(Island& island, const Pose& pose, double mass, double omega, const Twist& drift) {
  Mover& m = island.add();
  m.slot = static_cast<int>(island.movers().size()) - 2;
  m.pose = m.good = m.start = pose;
  m.mass = mass, m.inertia = mass * 35e-3 * 35e-3 / 6;
  m.inv_mass = 1 / m.mass, m.inv_inertia = 1 / m.inertia;
  m.reach = 35e-3 * std::sqrt(0.5), m.motion_bound = 0.1;
  m.twist = {drift.vx - omega * pose.y, drift.vy + omega * pose.x, omega};
}

// Two that turn as one rigid body overlap a little beyond what is left alone; the second one's
// centre is anywhere, also behind the first, towards which it is then pushed: turning faster costs
// energy, which no slowing within the pair can pay for.
TEST(Island, APairThatMovesAsOneMayBePushed) {
  const Model model = standard_model();
  for (int i = 0; i < 20000; ++i) {
    Island island(model);
    const auto u = [&](std::uint32_t which) { return lilytank::test::uniform_at(77, i, which); };
    const double apart = 35e-3 - reference::kPushTo - 1e-14 * std::pow(1e9, u(0)),
                 omega = 4 * u(1) - 2;
    const Twist drift{u(2) - 0.5, u(3) - 0.5, 0};
    ContactPair pair;
    pair.a = 1, pair.b = 2, pair.order_a = 0, pair.order_b = 1;
    pair.bx = 0.12 * u(4) - 0.06, pair.by = 0.12 * u(5) - 0.06;
    add_square(island, {0, 0, {1, 0}}, 0.07, omega, drift);
    add_square(island, {apart - pair.bx, 0.02 * u(6) - pair.by, {1, 0}}, 0.245, omega, drift);
    island.add(pair);
    island.survey();
    const Momenta before = momenta(island);
    island.push_apart(3);
    const Momenta after = momenta(island);
    ASSERT_NEAR(after.x, before.x, 1e-15) << i;
    ASSERT_NEAR(after.y, before.y, 1e-15) << i;
    ASSERT_NEAR(after.spin, before.spin, 1e-15) << i;
    // Nobody is pushed by more than 10 um: a rigid pair that keeps its spin needs little more.
    ASSERT_LE(after.energy, before.energy * (1 + 1e-2)) << i;
  }
}

}  // namespace
}  // namespace lilytank::test
