// The controller as a whole.
#include <gtest/gtest.h>

#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::chain;
using lilytank::test::quiet_model;
using lilytank::test::Rig;

namespace {

TEST(Controller, StepsWithinATickDoNotCount) {
  Model fine = quiet_model(2, {chain()});
  fine.steps_per_tick = 5, fine.dt = kTick / 5;
  Rig a(2, {chain()}), b(std::move(fine), 1);
  for (Rig* rig : {&a, &b}) {
    rig->place(0, 0, 0);
    rig->place_at(1, 2, 0, 0);
    rig->run(500);
  }
  ASSERT_EQ(a.log.size(), b.log.size());
  for (std::size_t k = 0; k < a.log.size(); ++k) {
    EXPECT_EQ(a.log[k].kind, b.log[k].kind);
    EXPECT_EQ(5 * a.log[k].step, b.log[k].step);
  }
}

}  // namespace
