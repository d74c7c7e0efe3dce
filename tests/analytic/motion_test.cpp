// Motion of single bodies against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "support/worlds.hpp"

namespace lilytank {
namespace {

using test::advance;
using test::force;

// Constant push against quadratic drag: v = sqrt(2 F / (K_F rho a h)) face on, and the projected
// area is sqrt(2) larger for a square on its corner.
TEST(Analytic, TerminalSpeedOfAPushedSquare) {
  for (const double degrees : {0.0, 45.0}) {
    Model model = test::lone_module({-1.5, 0, rotation(degrees * kPi / 180)});
    model.tank.radius = 5;
    model.forces = {force("face_drag", {0.442}), force("body_force", {0.01, 0})};
    World world(model, 1);
    ASSERT_TRUE(advance(world, 25));
    const double area = 0.035 * 0.035 * (degrees == 0 ? 1 : std::sqrt(2));
    const double want = std::sqrt(2 * 0.01 / (0.442 * 1000 * area));
    EXPECT_NEAR(world.kinematics().vx[0], want, 1e-5 * want);
    EXPECT_NEAR(world.kinematics().vy[0], 0, 1e-6);
    EXPECT_NEAR(world.kinematics().omega[0], 0, 1e-4);
  }
}

TEST(Analytic, TerminalSpeedOfABallInAStream) {
  Model model = test::lone_module();
  model.module.count = 0, model.ball.count = 1;
  model.start.poses = {Pose{-1, 0}};
  model.tank.radius = 8;
  model.field = test::uniform_water({0.1, 0, 0, 0}, 8);
  model.flow.K_v = 1;
  model.forces = {force("ball_drag", {0.47}), force("body_force", {0.002, 0})};
  World world(model, 1);
  ASSERT_TRUE(advance(world, 30));
  const double slip = std::sqrt(2 * 0.002 / (1000 * 7e-4 * 0.47));
  EXPECT_NEAR(world.kinematics().vx[0], 0.1 + slip, 1e-6);
}

// Torque of the face drag on a spinning square in still water, summed over the half of each face
// that meets the water: tau = -K_F rho draught 2 sum |s| (h^2 + s^2) ds omega^2, so omega falls as
// omega0 / (1 + beta omega0 t).
TEST(Analytic, SpinDownOfASquareFollowsItsIntegral) {
  for (const int segments : {10, 12}) {
    Model model = test::with_step(test::lone_module(), 25);
    model.forces = {force("face_drag", {0.442, double(segments)})};
    State state = initial_state(model, 1);
    state.omega[0] = 4;
    World world(model, state);
    const double h = model.module.side / 2, ds = 2 * h / segments;
    double sum = 0;
    for (int k = 0; k < segments; ++k) {
      const double s = (k + 0.5) * ds - h;
      if (s < 0) sum += -s * (h * h + s * s) * ds;
    }
    const double beta =
        0.442 * 0.5 * 1000 * model.module.draught * 4 * sum / model.module.inertia();
    for (int second = 1; second <= 20; ++second) {
      ASSERT_TRUE(advance(world, 1));
      const double want = 4 / (1 + beta * 4 * second);
      // One step of dt is off by dt beta omega^2 at most, relative dt beta omega.
      EXPECT_NEAR(world.kinematics().omega[0], want, want * 2 * model.dt * beta * 4);
    }
    // The sum over segments tends to the integral 3 h^4 / 4 a face.
    EXPECT_NEAR(sum, 0.75 * h * h * h * h, 0.03 * 0.75 * h * h * h * h);
  }
}

TEST(Analytic, DampingIsExponentialPerSecondForAnyStep) {
  for (const int k : {1, 5}) {
    Model model = test::with_step(test::lone_module(), k);
    model.tank.radius = 5;
    model.forces = {force("damping", {0.332, 0.12})};
    State state = initial_state(model, 1);
    state.vx[0] = 0.2, state.vy[0] = -0.1, state.omega[0] = 3;
    World world(model, state);
    ASSERT_TRUE(advance(world, 4));
    EXPECT_NEAR(world.kinematics().vx[0], 0.2 * std::pow(0.668, 4), 1e-7);
    EXPECT_NEAR(world.kinematics().vy[0], -0.1 * std::pow(0.668, 4), 1e-7);
    EXPECT_NEAR(world.kinematics().omega[0], 3 * std::pow(0.88, 4), 1e-6);
  }
}

// Bodies under the stochastic force and linear damping only: the variance of a sum of a first-order
// autoregression, per axis dt^2 s^2 sum_m ((1 - g^m) / (1 - g))^2, s the kick and g the damping.
TEST(Analytic, FreeDiffusionMatchesItsSum) {
  Model model;
  model.module.count = 0, model.ball.count = 1600;
  model.control.latches = false;
  model.tank.radius = 120;
  model.start = {Layout::lattice, 110, 4};
  model.field = test::still_water(120);
  model.forces = {force("stochastic", {0.01268}), force("damping", {0.332, 0})};
  World world(model, 3);
  const State start = world.state();
  const double kick = 0.01268 * kTick / model.ball.mass, g = std::pow(0.668, kTick);
  double expected = 0, power = 1;
  for (int step = 1; step <= 800; ++step) {
    ASSERT_EQ(world.step(), RunStatus::ok);
    power *= g;
    expected += std::pow((1 - power) / (1 - g), 2) * kick * kick * kTick * kTick;
    if (step % 200 != 0) continue;
    double square = 0;
    const int n = model.bodies();
    for (int i = 0; i < n; ++i) {
      square += std::pow(world.kinematics().x[i] - start.x[i], 2) +
                std::pow(world.kinematics().y[i] - start.y[i], 2);
    }
    const double samples = 2.0 * n;
    EXPECT_NEAR(square / samples, expected, 4 * expected * std::sqrt(2 / samples));
  }
}

// Semi-implicit Euler is of first order: without gusts, halving the step halves the error.
TEST(Analytic, HalvingTheStepHalvesTheError) {
  const auto end = [](int k) {
    Model model = test::with_step(test::lone_module({0.1, 0.02, rotation(0.3)}), k);
    model.field = std::make_shared<const FlowField>([] {
      FlowField f = analytic_tank({}, Interpolation::bilinear);
      std::vector<FlowSample> calm = f.samples();
      for (FlowSample& s : calm) s.sigma_x = s.sigma_y = 0;
      return FlowField(f.cells(), f.extent(), calm, f.measured(), Interpolation::bilinear);
    }());
    model.forces = {force("face_drag", {0.442}), force("damping", {0.332, 0.12})};
    World world(model, 1);
    EXPECT_TRUE(advance(world, 1.5));
    return Vec2(world.kinematics().x[0], world.kinematics().y[0]);
  };
  const Vec2 exact = 2 * end(128) - end(64);
  const double e1 = (end(2) - exact).norm(), e2 = (end(4) - exact).norm(),
               e4 = (end(8) - exact).norm();
  EXPECT_NEAR(e1 / e2, 2, 0.35);
  EXPECT_NEAR(e2 / e4, 2, 0.35);
}

}  // namespace
}  // namespace lilytank
