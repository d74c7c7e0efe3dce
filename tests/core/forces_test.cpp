#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "lilytank/force.hpp"
#include "support/moving_bodies.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

using test::force;
using test::MovingBodies;
using test::wrenches;

TEST(Forces, EveryTermIsDocumentedAndNamedOnce) {
  std::set<std::string_view> names;
  for (const ForceTerm* term : force_library()) {
    EXPECT_TRUE(names.insert(term->name()).second);
    EXPECT_EQ(find_force(term->name()), term);
    EXPECT_FALSE(term->summary().empty());
    EXPECT_FALSE(term->equation().empty());
    ASSERT_FALSE(term->parameters().empty());
    for (const Parameter& p : term->parameters()) {
      EXPECT_LE(p.low, p.standard);
      EXPECT_LE(p.standard, p.high);
      EXPECT_FALSE(p.unit.empty());
      EXPECT_FALSE(p.meaning.empty());
    }
  }
  EXPECT_EQ(find_force("gravity"), nullptr);
}

TEST(Forces, EveryTermIsFiniteAndLinearInItsStrengthAndZeroWithoutIt) {
  const Model model = standard_model();
  for (const ForceTerm* term : force_library()) {
    const MovingBodies bodies(12, 6, 11);
    ActiveForce one = with_defaults(*term), two = one, none = one;
    one.p[0] = 0.01, two.p[0] = 0.02, none.p[0] = 0;
    const StepContext now{.time = 1, .step = 40, .gust = 40, .seed = 3};
    const auto a = wrenches(model, bodies, one, now), b = wrenches(model, bodies, two, now);
    const auto zero = wrenches(model, bodies, none, now);
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_TRUE(std::isfinite(a[i].fx + a[i].fy + a[i].torque)) << term->name();
      EXPECT_NEAR(b[i].fx, 2 * a[i].fx, 1e-12) << term->name();
      EXPECT_NEAR(b[i].fy, 2 * a[i].fy, 1e-12) << term->name();
      EXPECT_NEAR(b[i].torque, 2 * a[i].torque, 1e-12) << term->name();
      EXPECT_EQ(zero[i].fx, 0) << term->name();
      EXPECT_EQ(zero[i].torque, 0) << term->name();
    }
  }
}

TEST(BallDrag, MatchesEquationTwo) {
  Model model = test::lone_module();
  model.module.count = 0, model.ball.count = 1;
  model.field = test::uniform_water({0.3, 0.4, 0, 0});
  model.flow.K_v = 1;
  MovingBodies bodies(0, 1, 1, 0);
  const Wrench w = wrenches(model, bodies, force("ball_drag", {0.47}), {})[0];
  EXPECT_NEAR(w.fx, 0.5 * 1000 * 7e-4 * 0.47 * 0.5 * 0.3, 1e-12);
  EXPECT_NEAR(w.fy, 0.5 * 1000 * 7e-4 * 0.47 * 0.5 * 0.4, 1e-12);
  EXPECT_EQ(w.torque, 0);
}

TEST(Stochastic, HasItsDeviationAndDiffersBetweenBodies) {
  Model model = standard_model();
  const MovingBodies bodies(40, 0, 1);
  double square = 0;
  const int steps = 2000;
  for (int step = 0; step < steps; ++step) {
    const auto w = wrenches(model, bodies, force("stochastic", {0.01}), {.step = step, .seed = 4});
    for (const Wrench& one : w) square += one.fx * one.fx + one.fy * one.fy;
    EXPECT_NE(w[0].fx, w[25].fx);
  }
  const double n = 2.0 * 40 * steps;
  EXPECT_NEAR(std::sqrt(square / n), 0.01, 4 * 0.01 / std::sqrt(2 * n));
}

TEST(PairAttraction, PullsAlongTheCentresWithEqualAndOppositeForces) {
  const Model model = standard_model();
  MovingBodies bodies(2, 0, 1);
  bodies.x = {0, 0.047}, bodies.y = {0, 0};
  const auto w = wrenches(model, bodies, force("pair_attraction", {0.004, 0.012}), {});
  EXPECT_NEAR(w[0].fx, 0.004 * std::exp(-1), 1e-12);
  EXPECT_NEAR(w[0].fy, 0, 1e-15);
  EXPECT_EQ(w[1].fx, -w[0].fx);
}

}  // namespace
}  // namespace lilytank
