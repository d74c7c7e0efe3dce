#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "lilytank/force.hpp"
#include "support/face_drag_reference.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

using test::force;

// Arrays that a Kinematics looks into, filled with random motion.
struct Bodies {
  std::vector<double> x, y, c, s, vx, vy, omega;
  std::vector<std::uint8_t> covered;
  int modules;
  Bodies(int modules_, int balls, std::uint64_t seed, double speed = 0.3) : modules(modules_) {
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

std::vector<Wrench> wrenches(const Model& model, const Bodies& bodies, const ActiveForce& f,
                             const Moment& now) {
  std::vector<Wrench> out(bodies.x.size());
  f.term->add(model, bodies.view(), now, f.p, out);
  return out;
}

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
    const Bodies bodies(12, 6, 11);
    ActiveForce one = with_defaults(*term), two = one, none = one;
    one.p[0] = 0.01, two.p[0] = 0.02, none.p[0] = 0;
    const Moment now{.time = 1, .step = 40, .gust = 40, .seed = 3};
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

// float32 against float64: 40 terms, each with a relative error of a few 2^-24 and a flow lookup
// with 2e-6 of a cell.
TEST(FaceDrag, FastKernelMatchesTheReference) {
  for (const Gusts gusts : {Gusts::per_point, Gusts::per_module}) {
    for (const int segments : {1, 4, 10, 12}) {
      Model model = standard_model();
      model.flow.gusts = gusts;
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const Bodies bodies(30, 0, seed);
        const Moment now{.step = 9, .gust = 9, .seed = seed};
        const auto fast =
            wrenches(model, bodies, force("face_drag", {0.442, double(segments)}), now);
        for (int i = 0; i < 30; ++i) {
          const Wrench want =
              test::face_drag_reference(model, bodies.view(), now, 0.442, segments, i);
          const double scale = 0.5 * 0.442 * 1000 * 0.035 * 0.035;  // N per (m/s)^2
          EXPECT_NEAR(fast[i].fx, want.fx, 5e-6 * scale);
          EXPECT_NEAR(fast[i].fy, want.fy, 5e-6 * scale);
          EXPECT_NEAR(fast[i].torque, want.torque, 5e-6 * scale * 0.025);
        }
      }
    }
  }
}

TEST(FaceDrag, NearestLookupMatchesTheReferenceToo) {
  Model model = standard_model();
  model.field = std::make_shared<const FlowField>(analytic_tank({}, Interpolation::nearest));
  const Bodies bodies(30, 0, 4);
  const Moment now{.gusts = false};
  const auto fast = wrenches(model, bodies, force("face_drag", {0.442, 10}), now);
  int differ = 0;
  for (int i = 0; i < 30; ++i) {
    const Wrench want = test::face_drag_reference(model, bodies.view(), now, 0.442, 10, i);
    // A point within rounding of a cell's border may fall into the other cell.
    differ += std::fabs(fast[i].fx - want.fx) > 5e-6 || std::fabs(fast[i].fy - want.fy) > 5e-6;
  }
  EXPECT_LE(differ, 1);
}

TEST(FaceDrag, ForceIsTheProjectedAreaTimesTheSquareOfTheFlow) {
  Model model = test::lone_module();
  model.field = test::uniform_water({0.2 / model.flow.K_v, 0, 0, 0});
  const double full = 0.5 * 1000 * 0.442 * 0.035 * 0.035 * 0.2 * 0.2;
  for (const double degrees : {0.0, 10.0, 45.0, 80.0}) {
    Bodies bodies(1, 0, 1, 0);
    const Rot r = rotation(degrees * kPi / 180);
    bodies.c = {r.c}, bodies.s = {r.s}, bodies.omega = {0}, bodies.covered = {0};
    const Wrench w = wrenches(model, bodies, force("face_drag", {0.442}), {})[0];
    EXPECT_NEAR(w.fx, full * (r.c + r.s), 1e-6 * full);
    EXPECT_NEAR(w.fy, 0, 1e-6 * full);
  }
}

TEST(FaceDrag, CoveredFacesFeelNothingUnlessShadowingIsOff) {
  Model model = test::lone_module();
  model.field = test::uniform_water({0.2, 0, 0, 0});
  Bodies bodies(1, 0, 1, 0);
  bodies.c = {1}, bodies.s = {0}, bodies.omega = {0}, bodies.covered = {1u << 2};
  const ActiveForce drag = force("face_drag", {0.442});
  EXPECT_EQ(wrenches(model, bodies, drag, {})[0].fx, 0);
  model.module.shadowing = false;
  EXPECT_GT(wrenches(model, bodies, drag, {})[0].fx, 0);
}

TEST(FaceDrag, AGustIsHeldFor25Milliseconds) {
  const Model model = test::with_step(standard_model(), 5);
  const Bodies bodies(5, 0, 2);
  const ActiveForce drag = force("face_drag", {0.442});
  const auto a = wrenches(model, bodies, drag, {.step = 10, .gust = 2, .seed = 1});
  const auto b = wrenches(model, bodies, drag, {.step = 14, .gust = 2, .seed = 1});
  const auto c = wrenches(model, bodies, drag, {.step = 15, .gust = 3, .seed = 1});
  EXPECT_EQ(a[0].fx, b[0].fx);
  EXPECT_NE(a[0].fx, c[0].fx);
}

TEST(BallDrag, MatchesEquationTwo) {
  Model model = test::lone_module();
  model.module.count = 0, model.ball.count = 1;
  model.field = test::uniform_water({0.3, 0.4, 0, 0});
  model.flow.K_v = 1;
  Bodies bodies(0, 1, 1, 0);
  const Wrench w = wrenches(model, bodies, force("ball_drag", {0.47}), {})[0];
  EXPECT_NEAR(w.fx, 0.5 * 1000 * 7e-4 * 0.47 * 0.5 * 0.3, 1e-12);
  EXPECT_NEAR(w.fy, 0.5 * 1000 * 7e-4 * 0.47 * 0.5 * 0.4, 1e-12);
  EXPECT_EQ(w.torque, 0);
}

TEST(Stochastic, HasItsDeviationAndDiffersBetweenBodies) {
  Model model = standard_model();
  const Bodies bodies(40, 0, 1);
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
  Bodies bodies(2, 0, 1);
  bodies.x = {0, 0.047}, bodies.y = {0, 0};
  const auto w = wrenches(model, bodies, force("pair_attraction", {0.004, 0.012}), {});
  EXPECT_NEAR(w[0].fx, 0.004 * std::exp(-1), 1e-12);
  EXPECT_NEAR(w[0].fy, 0, 1e-15);
  EXPECT_EQ(w[1].fx, -w[0].fx);
}

}  // namespace
}  // namespace lilytank
