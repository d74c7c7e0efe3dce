// Physics beyond the baseline: each term against values worked out by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "forces/force_sum.hpp"
#include "lilytank/force.hpp"
#include "support/moving_bodies.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

using test::force;
using test::MovingBodies;
using test::wrenches;

// What a term does to the water at each body.
struct Stirred {
  std::vector<double> x, y, turning, drag;
  double gain = 1, gust_gain = 1;
};
Stirred stirred(const Model& model, const MovingBodies& bodies, const ActiveForce& f,
                const StepContext& now) {
  const std::vector<double> none(bodies.x.size(), 0.0);
  Stirred s{none, none, none, std::vector<double>(bodies.x.size(), 1.0)};
  FlowPerturbation water{1, s.x, s.y, s.turning, 1, s.drag};
  f.term->perturb_flow(model, bodies.view(), now, f.p, water);
  s.gain = water.gain, s.gust_gain = water.gust_gain;
  return s;
}
std::vector<Wrench> transformed(const Model& model, const MovingBodies& bodies,
                                const ActiveForce& f, std::vector<Wrench> sum) {
  f.term->transform(model, bodies.view(), {}, f.p, sum);
  return sum;
}

// One module in the middle, at rest, and how it moves.
MovingBodies lone(double vx = 0, double vy = 0, double omega = 0) {
  MovingBodies b(1, 0, 1, 0);
  b.x = {0}, b.y = {0}, b.c = {1}, b.s = {0}, b.vx = {vx}, b.vy = {vy}, b.omega = {omega};
  return b;
}
// Two modules whose centres are `distance` apart along x, parallel.
MovingBodies pair_of(double distance) {
  MovingBodies b(2, 0, 1, 0);
  b.x = {0, distance}, b.y = {0, 0}, b.c = {1, 1}, b.s = {0, 0}, b.omega = {0, 0};
  return b;
}
Model uniform_flow(double ux, double uy = 0) {
  Model model = standard_model();
  model.field = test::uniform_water({ux, uy, 0, 0});
  model.flow.K_v = 1;
  return model;
}

TEST(CandidateForces, WhatTermsDoToTheWaterIsFiniteLinearAndNothingWithoutThem) {
  const Model model = standard_model();
  const StepContext now{.time = 1.3, .step = 52, .gust = 52, .seed = 3};
  for (const ForceTerm* term : force_library()) {
    if (!term->perturbs_flow()) continue;
    const MovingBodies bodies(12, 6, 11);
    ActiveForce one = with_defaults(*term), two = one, none = one;
    one.p[0] = 0.01, two.p[0] = 0.02, none.p[0] = 0;
    const Stirred a = stirred(model, bodies, one, now), b = stirred(model, bodies, two, now);
    const Stirred zero = stirred(model, bodies, none, now);
    double size = std::fabs(a.gain - 1);
    EXPECT_NEAR(b.gain - 1, 2 * (a.gain - 1), 1e-12) << term->name();
    EXPECT_EQ(zero.gain, 1) << term->name();
    for (std::size_t i = 0; i < a.x.size(); ++i) {
      size += std::fabs(a.x[i]) + std::fabs(a.y[i]);
      EXPECT_NEAR(b.x[i], 2 * a.x[i], 1e-12) << term->name();
      size += std::fabs(a.drag[i] - 1);
      EXPECT_NEAR(b.y[i], 2 * a.y[i], 1e-12) << term->name();
      EXPECT_NEAR(b.drag[i] - 1, 2 * (a.drag[i] - 1), 1e-12) << term->name();
      EXPECT_EQ(std::fabs(zero.x[i]) + std::fabs(zero.y[i]), 0) << term->name();
      EXPECT_EQ(zero.drag[i], 1) << term->name();
    }
    EXPECT_GT(size, 0) << term->name();
  }
}

// Nothing outside pushes two modules that only act on each other.
TEST(CandidateForces, TermsBetweenTwoModulesKeepBothMomenta) {
  const Model model = standard_model();
  for (const char* name :
       {"pair_attraction", "pair_repulsion", "magnetic_dipole", "latch_stick", "lubrication"}) {
    for (int seed = 1; seed <= 20; ++seed) {
      MovingBodies b(2, 0, static_cast<std::uint64_t>(seed));
      b.x[1] = b.x[0] + 0.028 + 0.0005 * seed, b.y[1] = b.y[0] + 0.02;
      ActiveForce f = with_defaults(*find_force(name));
      f.p[0] = 0.01;
      if (f.term->name() == "latch_stick") f.p[1] = 0.005;
      const auto w = wrenches(model, b, f, {});
      const double size = std::fabs(w[0].fx) + std::fabs(w[0].fy);
      EXPECT_GT(size, 0) << name;
      EXPECT_NEAR(w[0].fx + w[1].fx, 0, 1e-15 + 1e-12 * size) << name;
      EXPECT_NEAR(w[0].fy + w[1].fy, 0, 1e-15 + 1e-12 * size) << name;
      const double turning =
          w[0].torque + w[1].torque + (b.x[1] - b.x[0]) * w[1].fy - (b.y[1] - b.y[0]) * w[1].fx;
      EXPECT_NEAR(turning, 0, 1e-16 + 1e-13 * size) << name << " " << seed;
    }
  }
}

TEST(CandidateForces, ResistanceTakesEnergyAway) {
  const Model model = standard_model();
  for (int seed = 1; seed <= 50; ++seed) {
    MovingBodies b(2, 0, static_cast<std::uint64_t>(seed));
    b.x[1] = b.x[0] + 0.04, b.y[1] = b.y[0] + 0.01;
    const auto w = wrenches(model, b, force("lubrication", {0.02, 0.004}), {});
    double power = 0;
    for (int i = 0; i < 2; ++i)
      power += w[i].fx * b.vx[i] + w[i].fy * b.vy[i] + w[i].torque * b.omega[i];
    EXPECT_LE(power, 1e-15);
  }
}

TEST(CandidateForces, PairsByHand) {
  const Model model = standard_model();
  const double side = model.module.side;
  EXPECT_NEAR(wrenches(model, pair_of(side + 0.012), force("pair_repulsion", {0.004}), {})[0].fx,
              -0.004 * std::exp(-1), 1e-12);
  // Dipoles in line pull with `strength` a side apart, and a sixteenth of it two sides apart.
  const auto near = wrenches(model, pair_of(side), force("magnetic_dipole", {0.01}), {});
  EXPECT_NEAR(near[0].fx, 0.01, 1e-12);
  EXPECT_NEAR(near[0].torque, 0, 1e-15);
  EXPECT_NEAR(wrenches(model, pair_of(2 * side), force("magnetic_dipole", {0.01}), {})[1].fx,
              -0.01 / 16, 1e-12);
  // Side by side they repel with half of it, and one across the other's field is turned into it.
  const auto beside = wrenches(model, pair_of(side), force("magnetic_dipole", {0.01, kPi / 2}), {});
  EXPECT_NEAR(beside[0].fx, -0.005, 1e-12);
  MovingBodies crossed = pair_of(side);
  crossed.c[0] = 0, crossed.s[0] = 1;
  EXPECT_NEAR(wrenches(model, crossed, force("magnetic_dipole", {0.01}), {})[0].torque,
              -0.01 * side / 3, 1e-12);
  EXPECT_NEAR(wrenches(model, pair_of(side + 2e-4), force("latch_stick", {0.005}), {})[0].fx,
              0.005 * std::exp(-1), 1e-12);
  MovingBodies closing = pair_of(side + 0.004);
  closing.vx = {0.1, 0};
  const auto film = wrenches(model, closing, force("lubrication", {0.02}), {});
  EXPECT_NEAR(film[0].fx, -0.02 * 0.1 * std::exp(-1), 1e-12);
  EXPECT_NEAR(film[0].torque, 0, 1e-15);
}

TEST(CandidateForces, TheGapOfTurnedSquaresIsFromCornerToFace) {
  const Model model = standard_model();
  const double half = model.module.side / 2;
  MovingBodies b = pair_of(half + half * std::sqrt(2) + 2e-4);
  b.c[1] = b.s[1] = std::sqrt(0.5);
  EXPECT_NEAR(wrenches(model, b, force("latch_stick", {0.005}), {})[0].fx, 0.005 * std::exp(-1),
              1e-10);
}

TEST(CandidateForces, StreamsByHand) {
  const Model model = uniform_flow(0.2);
  const double side = model.module.side, rho = model.flow.rho, h = model.module.draught;
  EXPECT_NEAR(wrenches(model, lone(0.05), force("viscous_drag", {0.1}), {})[0].fx, 0.015, 1e-9);
  // Counter-clockwise spin in a stream along +x: the lift is to the right of the stream, -y.
  const Wrench lift = wrenches(model, lone(0, 0, 3), force("magnus_lift", {1}), {})[0];
  EXPECT_NEAR(lift.fy, -rho * h * 2 * side * side * 3 * 0.2, 1e-9);
  EXPECT_NEAR(lift.fx, 0, 1e-12);
  EXPECT_NEAR(wrenches(model, lone(0, 0, 3), force("rotational_drag", {1e-4}), {})[0].torque, -3e-4,
              1e-9);
  const Wrench left = wrenches(model, lone(0.1), force("coriolis", {0.5}), {})[0];
  EXPECT_NEAR(left.fy, model.module.mass * 0.05, 1e-15);
  // A module 2 cm behind another misses a share of the stream, one beside it hardly any.
  MovingBodies row = pair_of(0.05);
  Stirred wake = stirred(model, row, force("wake_shielding", {0.5, 0.05, 0.02}), {});
  EXPECT_NEAR(wake.x[1], -0.5 * std::exp(-1) * 0.2, 1e-9);
  EXPECT_EQ(wake.x[0], 0);
  row.x = {0, 0}, row.y = {0, 0.1};
  wake = stirred(model, row, force("wake_shielding", {0.5, 0.05, 0.02}), {});
  EXPECT_EQ(wake.x[1], 0);
}

// However many stand before it, a module misses no more than the whole stream.
TEST(CandidateForces, ARowOfModulesTurnsNoStreamAbout) {
  const Model model = uniform_flow(0.2);
  MovingBodies row(6, 0, 1, 0);
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    row.x[k] = 0.037 * i, row.y[k] = 0, row.c[k] = 1, row.s[k] = 0, row.omega[k] = 0;
  }
  const Stirred wake = stirred(model, row, force("wake_shielding", {1, 0.08, 0.02}), {});
  for (std::size_t i = 0; i < 6; ++i) EXPECT_GE(wake.x[i], -0.2 - 1e-12) << i;
  EXPECT_NEAR(wake.x[5], -0.2, 1e-12);
}

// A layer and a wake take a share of the water that there is, whatever the pumps do.
TEST(CandidateForces, WhatSlowsTheWaterSlowsAsMuchAsPumpsMove) {
  Model model = uniform_flow(0.2);
  MovingBodies b = lone();
  b.y = {model.tank.radius - 0.01};
  for (const ActiveForce& pumps :
       {force("flow_drift", {0.5}), force("flow_pulsation", {0.5, 1, 0})}) {
    const std::string_view name = pumps.term->name();
    model.forces = {force("wall_layer", {1, 0.1}), pumps};
    ForceSum sum(model);
    StepContext now{.time = 1, .gusts = false};
    sum.perturb_flow(b.view(), now);
    EXPECT_NEAR(now.gain, 1.5, 1e-9) << name;
    EXPECT_NEAR(now.ux[0], -1.5 * std::exp(-0.1) * 0.2, 1e-9) << name;
  }
}

// Of an assembly only the sum of forces counts: inner ones must go on cancelling each other.
TEST(CandidateForces, AHeavyModuleDrivesNoAssembly) {
  const Model model = standard_model();
  MovingBodies b = pair_of(model.module.side);
  b.covered = {1, 4};
  const auto changed =
      transformed(model, b, force("heterogeneous_module", {1, 0}), {{0.01, 0, 0}, {-0.01, 0, 0}});
  EXPECT_EQ(changed[0].fx + changed[1].fx, 0);
}

// Numbers nearest to 1 make a length of 0: these two seeds have one.
TEST(CandidateForces, EddiesOfEverySeedAreFinite) {
  const Model model = standard_model();
  for (const std::uint64_t seed : {559079u, 966946u}) {
    const StepContext now{.time = 1.3, .step = 52, .gust = 52, .seed = seed};
    const Stirred s = stirred(model, lone(), force("correlated_gusts", {0.02}), now);
    EXPECT_TRUE(std::isfinite(s.x[0]) && std::isfinite(s.y[0])) << seed;
  }
}

TEST(CandidateForces, WallsByHand) {
  const Model model = uniform_flow(0.2);
  MovingBodies b = lone();
  b.x = {0}, b.y = {model.tank.radius - model.module.side / 2 - 0.004};
  const Wrench pull = wrenches(model, b, force("wall_force", {0.001}), {})[0];
  EXPECT_NEAR(pull.fy, 0.001 * std::exp(-1), 1e-12);
  b.y = {model.tank.radius - 0.01};
  EXPECT_NEAR(stirred(model, b, force("wall_layer", {0.5}), {}).x[0], -0.5 * std::exp(-1) * 0.2,
              1e-9);
}

TEST(CandidateForces, PumpsByHand) {
  const Model model = uniform_flow(0.2);
  const StepContext now{.time = 2.5};
  const auto pulse = force("flow_pulsation", {0.2, 0.9, 0.4});
  EXPECT_NEAR(stirred(model, lone(), pulse, now).gain,
              1 + 0.2 * std::cos(2 * kPi * 0.9 * 2.5 + 0.4), 1e-12);
  EXPECT_NEAR(stirred(model, lone(), force("flow_drift", {-0.01}), now).gain, 0.975, 1e-15);
  MovingBodies b = lone();
  b.x = {0.13}, b.y = {0.1};
  const Stirred s = stirred(model, b, force("local_flow", {0.1, -0.2, 0.1, 0.1, 0.03}), now);
  EXPECT_NEAR(s.x[0], 0.1 * std::exp(-0.5), 1e-12);
  EXPECT_NEAR(s.y[0], -0.2 * std::exp(-0.5), 1e-12);
}

// Drag of modules and of balls; other forces as elsewhere.
TEST(CandidateForces, PatchByHand) {
  Model model = uniform_flow(0.2);
  model.module.count = 2, model.ball.count = 1;
  MovingBodies b(2, 1, 1, 0);
  b.x = {0.1, 0.16, 0.1}, b.y = {0.1, 0.1, 0.16}, b.c = {1, 1, 1}, b.s = {0, 0, 0};
  const ActiveForce patch = force("drag_patch", {1.5, 0.1, 0.1, 0.06});
  const double edge = 1 + 1.5 * std::exp(-1);
  const std::vector<double> factor = stirred(model, b, patch, {}).drag;
  EXPECT_NEAR(factor[0], 2.5, 1e-15);
  EXPECT_NEAR(factor[1], edge, 1e-12);
  model.forces = {force("face_drag", {0.5, 10}), force("ball_drag", {0.47, 10}),
                  force("body_force", {0.001, 0})};
  std::vector<Wrench> without(3), with(3);
  const StepContext now{.gusts = false};
  ForceSum(model, model.forces)(b.view(), now, without);
  model.forces.push_back(patch);
  ForceSum(model, model.forces)(b.view(), now, with);
  EXPECT_NEAR(with[0].fx - 0.001, 2.5 * (without[0].fx - 0.001), 1e-12);
  EXPECT_NEAR(with[1].fx - 0.001, edge * (without[1].fx - 0.001), 1e-12);
  EXPECT_NEAR(with[2].fx - 0.001, edge * (without[2].fx - 0.001), 1e-12);
}

TEST(CandidateForces, BodiesByHand) {
  const Model model = standard_model();
  MovingBodies b = lone();
  b.c = {0}, b.s = {1};
  const Wrench own = wrenches(model, b, force("self_propulsion", {0.001, 0.002}), {})[0];
  EXPECT_NEAR(own.fx, -0.002, 1e-15);
  EXPECT_NEAR(own.fy, 0.001, 1e-15);
  EXPECT_EQ(wrenches(model, b, force("spin_torque", {1e-5}), {})[0].torque, 1e-5);
  // The centre of mass is 1 mm along +y here; a push along +x is then to its right.
  const Wrench off = transformed(model, b, force("mass_offset", {0.001, 0}), {{0.01, 0, 0}})[0];
  EXPECT_NEAR(off.torque, 0.001 * 0.01, 1e-15);
  EXPECT_NEAR(transformed(model, b, force("heterogeneous_module", {0.25, 0}), {{0.01, 0, 0}})[0].fx,
              0.008, 1e-15);
  EXPECT_EQ(transformed(model, b, force("heterogeneous_module", {0.25, 1}), {{0.01, 0, 0}})[0].fx,
            0.01);
}

TEST(CandidateForces, AddedMassDividesForcesAndFollowsTheWater) {
  Model model = uniform_flow(0.2);
  const double displaced =
      model.flow.rho * model.module.side * model.module.side * model.module.draught;
  const double share = model.module.mass / (model.module.mass + 0.5 * displaced);
  const Wrench w = transformed(model, lone(), force("added_mass", {0.5}), {{0.01, 0, 1e-4}})[0];
  EXPECT_NEAR(w.fx, 0.01 * share, 1e-9);
  EXPECT_NEAR(w.torque, 1e-4 * share, 1e-9);
}

TEST(CandidateForces, EddiesHaveTheirDeviationTimeAndLength) {
  const Model model = uniform_flow(0);
  MovingBodies b(3, 0, 1, 0);
  b.x = {0, 0.06, 0}, b.y = {0, 0, 0.06};
  const auto eddies = force("correlated_gusts", {0.05, 0.5, 0.06});
  double square = 0, later = 0, along = 0, across = 0;
  const int worlds = 4000;
  for (int w = 0; w < worlds; ++w) {
    const auto seed = static_cast<std::uint64_t>(w + 1);
    const Stirred a = stirred(model, b, eddies, {.time = 3, .seed = seed});
    const Stirred c = stirred(model, b, eddies, {.time = 3.5, .seed = seed});
    square += a.x[0] * a.x[0], later += a.x[0] * c.x[0];
    along += a.x[0] * a.x[1], across += a.x[0] * a.x[2];
  }
  // Products of unit normals have a deviation of at most sqrt(2).
  const double unit = 0.05 * 0.05, error = 4 * std::sqrt(2.0 / worlds);
  EXPECT_NEAR(square / worlds / unit, 1, 1.5 * error);
  EXPECT_NEAR(later / worlds / unit, std::exp(-1), error);
  // A flow without divergence is longer correlated along its direction than across.
  EXPECT_GT(along / worlds / unit, std::exp(-0.5) - error);
  EXPECT_LT(across / worlds / unit, std::exp(-0.5) - 0.1);
}

// Half of the curl, by the velocities on four sides: a module's, or very near ones.
TEST(CandidateForces, WaterThatIsStirredTurnsModulesByItsCurl) {
  const Model model = uniform_flow(0.2);
  const double half = model.module.side / 2;
  struct Case {
    ActiveForce term;
    double h, error;  // eddies are summed in single precision
  };
  for (const auto& [term, h, error] :
       {Case{force("correlated_gusts", {0.05, 0.5, 0.03}), half, 1e-4},
        Case{force("local_flow", {0.1, -0.04, 0, 0, 0.2}), 1e-5, 1e-8},
        Case{force("wall_layer", {0.5, 0.05}), 1e-5, 1e-8}}) {
    MovingBodies b(5, 0, 1, 0);
    b.x = {0.01, 0.01 + h, 0.01 - h, 0.01, 0.01}, b.y = {0.2, 0.2, 0.2, 0.2 + h, 0.2 - h};
    const Stirred s = stirred(model, b, term, {.time = 1, .seed = 7});
    const double curl = (s.y[1] - s.y[2] - s.x[3] + s.x[4]) / (2 * h);
    EXPECT_NEAR(s.turning[0], curl / 2, error * std::fabs(curl)) << term.term->name();
    EXPECT_GT(std::fabs(curl), 1e-3);
  }
  // A module that turns with the water feels no torque.
  Model still = uniform_flow(0);
  still.flow.at = FlowAt::centre;
  MovingBodies turning = lone(0);
  turning.omega = {2};
  const std::vector<double> none{0}, water{2};
  const ActiveForce drag = force("face_drag", {0.5, 10});
  EXPECT_EQ(wrenches(still, turning, drag, {.ux = none, .uy = none, .turning = water})[0].torque,
            0);
  EXPECT_LT(wrenches(still, turning, drag, {})[0].torque, -1e-9);
}

// Eddies in the place of gusts leave the water's variance what it was.
TEST(CandidateForces, EddiesTakeTheirShareOfTheGusts) {
  Model model = uniform_flow(0.2);
  model.field = test::uniform_water({0.2, 0, 0.1, 0.1});
  MovingBodies b = lone(0);
  const auto eddies = force("correlated_gusts", {0, 0.5, 0.06, 0.7});
  double square = 0, left = 1;
  const int worlds = 4000;
  for (int w = 0; w < worlds; ++w) {
    const Stirred a = stirred(model, b, eddies, {.seed = static_cast<std::uint64_t>(w + 1)});
    square += a.x[0] * a.x[0], left = a.gust_gain;
  }
  const double sigma = model.flow.K_v * 0.1;
  EXPECT_NEAR(square / worlds / (sigma * sigma), 0.7, 6 * std::sqrt(2.0 / worlds));
  EXPECT_NEAR(left, std::sqrt(0.3), 1e-12);
}

TEST(CandidateForces, RandomForcesHaveTheirSizes) {
  const Model model = uniform_flow(0.2);
  MovingBodies b = lone(0.1);
  b.x = {0.15};
  double noise = 0, knocks = 0;
  const int steps = 40000;
  for (int step = 0; step < steps; ++step) {
    const StepContext now{.time = step * kTick, .step = step, .gust = step, .seed = 5};
    const double f = wrenches(model, b, force("state_dependent_noise", {0.01, 0.02}), now)[0].fx;
    const double k = wrenches(model, b, force("heavy_tailed_kicks", {1e-4, 4}), now)[0].fx;
    noise += f * f, knocks += k * k * kTick * kTick;
  }
  const double sigma = 0.01 * 0.5 + 0.02 * 0.1, spread = 4 * std::sqrt(2.0 / steps);
  EXPECT_NEAR(noise / steps / (sigma * sigma), 1, spread);
  // A tenth of the intervals has a knock; its square has a relative deviation of sqrt(3 / 0.1 - 1).
  EXPECT_NEAR(knocks / steps / 1e-8, 0.1, 0.1 * 4 * std::sqrt(29.0 / steps));
  double swing = 0;
  for (int step = 0; step < 4000; ++step) {
    const double f =
        wrenches(model, b, force("vortex_shedding", {1, 0.4}), {.time = step * kTick, .seed = 5})[0]
            .fy;
    swing += f * f;
  }
  const double amplitude =
      0.5 * model.flow.rho * model.module.draught * model.module.side * 0.1 * 0.1;
  EXPECT_NEAR(swing / 4000, amplitude * amplitude / 2, 1e-6 * amplitude * amplitude);
}

// A world with every term on stays a world: the same bits, whatever the order of bodies' work.
TEST(CandidateForces, WorldsRunWithEveryTermOn) {
  Model model = standard_model();
  for (const ForceTerm* term : force_library()) {
    if (term->baseline()) continue;
    ActiveForce f = with_defaults(*term);
    f.p[0] = 1e-4;
    model.forces.push_back(f);
  }
  World a(model, 3), b(model, 3);
  for (int step = 0; step < 400; ++step) {
    ASSERT_EQ(a.step(), RunStatus::ok);
    b.step();
  }
  EXPECT_EQ(fingerprint(a.state()), fingerprint(b.state()));
}

}  // namespace
}  // namespace lilytank
