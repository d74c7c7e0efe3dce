// The engine's contacts in lanes against the reference in double precision, a pair at a time.
#include <gtest/gtest.h>

#include "lilytank/random.hpp"
#include "support/bodies.hpp"
#include "support/reference/island_stepper.hpp"

namespace lilytank::test {
namespace {

double draw(std::uint32_t k, std::uint32_t index) {
  return 2 * uniform({53, Stream::start_pose, 0, k, index}) - 1;
}

// Two squares on their way to each other.
void aim(Bodies& b, std::uint32_t k) {
  const double angle = kPi * draw(k, 0), apart = 0.044 + 0.006 * draw(k, 1);
  const Rot way = rotation(angle);
  b.place(0, 0.05 * draw(k, 2), 0.05 * draw(k, 3), kPi * draw(k, 4));
  b.place(1, b.state.x[0] + apart * way.c, b.state.y[0] + apart * way.s, kPi * draw(k, 5));
  b.set_twist(0, 0.3 * way.c + 0.1 * draw(k, 6), 0.3 * way.s + 0.1 * draw(k, 7), 3 * draw(k, 8));
  b.set_twist(1, 0.1 * draw(k, 9), 0.1 * draw(k, 10), 3 * draw(k, 11));
  b.derive();
}

void add_mover(reference::Island& island, const Bodies& b, int slot) {
  reference::Mover& m = island.add();
  m.slot = slot;
  m.pose = {b.state.x[slot], b.state.y[slot], {b.state.c[slot], b.state.s[slot]}};
  m.twist = {b.state.vx[slot], b.state.vy[slot], b.state.omega[slot]};
  m.mass = b.model.module.mass, m.inertia = b.model.module.inertia();
  m.inv_mass = 1 / m.mass, m.inv_inertia = 1 / m.inertia;
  m.reach = b.model.module.side * std::sqrt(0.5), m.motion_bound = 1;
  m.good = m.start = m.pose, m.course = m.twist;
}

// Where corners are about to be faces, rounding may decide; such pairs are few.
TEST(Movers, PairsMoveAsInTheReference) {
  int met = 0, other = 0;
  for (std::uint32_t k = 0; k < 3000; ++k) {
    Bodies b(bare_model(2));
    aim(b, k);
    if (b.overlap() > 0) continue;
    reference::Island island(b.model);
    add_mover(island, b, 0), add_mover(island, b, 1);
    reference::ContactPair pair;
    pair.a = 1, pair.b = 2, pair.order_a = 0, pair.order_b = 1;
    island.add(pair);
    const double before = b.state.vx[1];
    Tallies tallies;
    reference::IslandStepper(b.model).run(island, b.model.dt, 1000000, tallies);
    b.step();
    met += b.state.vx[1] != before && std::fabs(b.state.vx[1] - before) > 1e-3;
    double off = 0;
    for (const int i : {0, 1}) {
      const reference::Mover& m = island.movers()[static_cast<std::size_t>(i + 1)];
      off = std::max({off, std::fabs(b.state.x[i] - m.pose.x) / 1e-6,
                      std::fabs(b.state.y[i] - m.pose.y) / 1e-6,
                      std::fabs(b.state.vx[i] - m.twist.vx) / 1e-4,
                      std::fabs(b.state.vy[i] - m.twist.vy) / 1e-4,
                      std::fabs(b.state.omega[i] - m.twist.omega) / 1e-2});
    }
    other += off > 1;
  }
  EXPECT_GT(met, 500);
  EXPECT_LT(other, 30);
}

}  // namespace
}  // namespace lilytank::test
