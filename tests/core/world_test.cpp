#include "lilytank/world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/worlds.hpp"

namespace lilytank {
namespace {

TEST(World, ADivergedWorldNamesStepBodyAndTheLargestForce) {
  Model model = standard_model();
  model.module.count = 3;
  model.control.latches = false;
  model.forces.push_back(test::force("body_force", {400, 0}));
  World world(model, 1);
  RunStatus status = RunStatus::ok;
  for (int i = 0; i < 400 && status == RunStatus::ok; ++i) status = world.step();
  ASSERT_EQ(status, RunStatus::diverged);
  EXPECT_EQ(world.divergence().force, "body_force");
  EXPECT_NEAR(world.divergence().size, 400, 1e-9);
  EXPECT_EQ(world.divergence().step, world.state().step);
  EXPECT_GE(world.divergence().body, 0);
  EXPECT_LT(world.divergence().body, 3);
  const auto before = fingerprint(world.state());
  EXPECT_EQ(world.step(), RunStatus::diverged);  // and nothing further happens
  EXPECT_EQ(fingerprint(world.state()), before);
}

TEST(World, NotANumberIsADivergenceToo) {
  Model model = standard_model();
  model.module.count = 2;
  model.forces.push_back(test::force("body_force", {std::nan(""), 0}));
  World world(model, 1);
  EXPECT_EQ(world.step(), RunStatus::diverged);
  EXPECT_EQ(world.divergence().force, "body_force");
}

TEST(World, TimeCountsSteps) {
  const Model model = test::with_step(test::lone_module(), 4);
  World world(model, 1);
  ASSERT_TRUE(test::advance(world, 2.5));
  EXPECT_EQ(world.state().step, 400);
  EXPECT_DOUBLE_EQ(world.time(), 2.5);
}

TEST(World, KinematicsFollowTheState) {
  const Model model = standard_model();
  World world(model, 3);
  ASSERT_TRUE(test::advance(world, 1));
  const Kinematics& k = world.kinematics();
  ASSERT_EQ(k.size(), 15);
  for (int i = 0; i < k.size(); ++i) {
    EXPECT_NEAR(k.c[i] * k.c[i] + k.s[i] * k.s[i], 1, 1e-6);
    EXPECT_LT(std::hypot(k.x[i], k.y[i]), model.tank.radius);
  }
}

TEST(InitialState, IsSpreadAsAsked) {
  const Model model = standard_model();
  for (std::uint64_t seed = 1; seed < 30; ++seed) {
    const State s = initial_state(model, seed);
    for (int i = 0; i < 15; ++i) {
      EXPECT_LE(std::hypot(s.x[i], s.y[i]), 0.20);
      for (int j = 0; j < i; ++j) EXPECT_GE(std::hypot(s.x[i] - s.x[j], s.y[i] - s.y[j]), 0.05);
    }
  }
}

TEST(InitialState, SaysWhenThereIsNoRoom) {
  Model model = standard_model();
  model.module.count = 80;
  EXPECT_THROW(initial_state(model, 1), InputError);
  model.start.layout = Layout::lattice;
  EXPECT_THROW(initial_state(model, 1), InputError);
  model.start = {Layout::poses, 0, 0, {Pose{}}};
  EXPECT_THROW(initial_state(model, 1), InputError);
  model.module.count = 1;
  model.start.poses = {Pose{0.29, 0}};
  EXPECT_THROW(initial_state(model, 1), InputError);
}

}  // namespace
}  // namespace lilytank
