// The baseline as a predictor, and what its innovations say of forces that it lacks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "forces/library.hpp"
#include "lilytank/camera.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/predictor.hpp"
#include "lilytank/world.hpp"
#include "scores/flow_uncertainty.hpp"
#include "scores/nuisances.hpp"
#include "scores/scores.hpp"
#include "support/filmed.hpp"
#include "support/moving_bodies.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

using test::drifting;
using test::filmed;
using test::MovingBodies;
using test::plan_for;

std::size_t entry_named(const ScorePlan& plan, const std::string& name) {
  const std::vector<ScoreEntry> entries = plan.entries();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].name == name) return i;
  }
  ADD_FAILURE() << "no score is named " << name;
  return 0;
}

TEST(ExpectedTank, KnowsNoChance) {
  Model model = drifting(6);
  model.expected = true;
  State start = initial_state(model, 1);
  World one(model, start);
  start.seed = 99;
  World other(model, start);
  for (int step = 0; step < 400; ++step) one.step(), other.step();
  EXPECT_EQ(one.state().x, other.state().x);
  EXPECT_EQ(one.state().omega, other.state().omega);
}

// The expected drag is the mean of drags with gusts: 4000 draws, five standard errors.
TEST(ExpectedTank, DragIsTheMeanOverGusts) {
  const Model model = drifting(1);
  MovingBodies body(1, 0, 1, 0);
  body.x = {0.1}, body.y = {0.02}, body.c = {0.8}, body.s = {0.6};
  body.vx = {0.05}, body.vy = {-0.02}, body.omega = {0.5};
  const ActiveForce* drag = nullptr;
  for (const ActiveForce& f : model.forces) {
    if (f.term->name() == "face_drag") drag = &f;
  }
  ASSERT_NE(drag, nullptr);
  std::vector<Wrench> expected(1);
  const StepContext calm{.gusts = false, .expected = true};
  drag->term->add(model, body.view(), calm, drag->p, expected);
  const int draws = 4000;
  double sum[3] = {0, 0, 0}, square[3] = {0, 0, 0};
  for (int k = 0; k < draws; ++k) {
    std::vector<Wrench> w(1);
    const StepContext now{.step = k * 5, .gust = k, .seed = 7};
    drag->term->add(model, body.view(), now, drag->p, w);
    const double v[3] = {w[0].fx, w[0].fy, w[0].torque};
    for (int c = 0; c < 3; ++c) sum[c] += v[c], square[c] += v[c] * v[c];
  }
  const double want[3] = {expected[0].fx, expected[0].fy, expected[0].torque};
  for (int c = 0; c < 3; ++c) {
    const double mean = sum[c] / draws;
    const double error = std::sqrt((square[c] / draws - mean * mean) / draws);
    EXPECT_NEAR(mean, want[c], 5 * error) << "component " << c;
  }
}

// With the right model the innovations have no mean and, by gains from the data, variance one.
TEST(Predictor, InnovationsOfTheRightModelAreNoise) {
  const Model model = drifting(6);
  const auto recordings = filmed(model, 30, 3);
  double sum = 0, square = 0, count = 0;
  predict(model, recordings, predictor_options(model, recordings), [&](const PredictedFrame& f) {
    for (std::size_t i = 0; i < f.dx.size(); ++i) {
      if (f.usable[i] == 0 || std::isnan(f.dx[i]) || f.contact[i] > 0.03) continue;
      for (const double z : {f.dx[i] / f.sd_x[i], f.dy[i] / f.sd_x[i]}) {
        sum += z, square += z * z, count += 1;
      }
    }
  });
  ASSERT_GT(count, 8000);
  // Neighbouring innovations are nearly independent.
  EXPECT_NEAR(sum / count, 0, 5 / std::sqrt(count));
  EXPECT_NEAR(square / count, 1, 0.15);
}

TEST(Predictor, RefusesTracksWithoutHeadings) {
  const Model model = drifting(2);
  auto recordings = filmed(model, 2, 1);
  for (Track& t : recordings[0].tracks) t.theta.clear();
  EXPECT_THROW(predict(model, recordings, {}, [](const PredictedFrame&) {}), InputError);
}

// A push that the model lacks shows in its own score, at its size; without it the score is small.
// The push is 4 mN where the score's unit is 1.5 mN.
TEST(Scores, SeeAPlantedPush) {
  const Model model = drifting(8);
  const std::vector<std::string> path{"forces.body_force.force_x"};
  const std::vector<double> value{4e-3};
  const auto without = filmed(model, 60, 5);
  const auto with = filmed(with_parameters(model, path, value), 40, 5);
  const ScorePlan plan = plan_for(model, without);
  const std::size_t at = entry_named(plan, "body_force force_x");
  const double nothing = score(plan, without)[at], pushed = score(plan, with)[at];
  EXPECT_LT(std::fabs(nothing), 1.0);
  EXPECT_NEAR(pushed - nothing, 4.0 / 1.5, 1.2);
}

// Every score moves by a planted force as far as the information that both share says: to five
// deviations of both recordings' noise, and a fifth of it, as the filter shows less than there is.
TEST(Scores, MoveByAForceAsInformationsSay) {
  const Model model = drifting(8);
  const auto without = filmed(model, 120, 5);
  const auto with =
      filmed(with_parameters(model, std::vector<std::string>{"forces.self_propulsion.force_x"},
                             std::vector<double>{6e-3}),
             120, 6);
  ScorePlan plan = plan_for(model, without);
  plan.shapes.clear();
  plan.nuisances = std::make_shared<const Nuisances>(model, FlowMaps(model.field), 3);
  const std::vector<double> before = score(plan, without), after = score(plan, with);
  const Eigen::MatrixXd shared = score_informations(plan, with);
  const auto own = static_cast<Eigen::Index>(entry_named(plan, "self_propulsion force_x"));
  const double amplitude = after[static_cast<std::size_t>(own)];
  EXPECT_NEAR(amplitude, 6, 1.5);  // in sizes of 1 mN
  int moved = 0;
  for (Eigen::Index k = 0; k < shared.rows(); ++k) {
    if (!(shared(k, k) > 0) || k == own) continue;
    const auto i = static_cast<std::size_t>(k);
    const double expected = amplitude * shared(k, own) / shared(k, k);
    const double noise = 5 * std::sqrt(2 / shared(k, k));
    moved += std::fabs(expected) > 2 * noise ? 1 : 0;
    EXPECT_NEAR(after[i] - before[i], expected, noise + 0.2 * std::fabs(expected))
        << plan.entries()[i].name;
  }
  EXPECT_GT(moved, 0);
}

// Drag that is a third stronger than the predictor's, or water that is a tenth faster, looks like
// many a force to scores that are not cleared of either.
TEST(Scores, AreClearedOfWhatACalibrationAbsorbs) {
  const Model model = drifting(8);
  const auto right = filmed(model, 60, 5);
  ScorePlan plain = plan_for(model, right);
  ScorePlan cleared = plain;
  cleared.nuisances = std::make_shared<const Nuisances>(model, FlowMaps(model.field), 3);
  const std::vector<double> plain_right = score(plain, right),
                            cleared_right = score(cleared, right);
  for (const auto& [path, value] :
       {std::pair<std::string, double>{"forces.face_drag.K_F", 0.6}, {"flow.K_v", 1.5}}) {
    const auto wrong = filmed(with_parameters(model, std::vector{path}, std::vector{value}), 60, 5);
    const std::vector<double> plain_wrong = score(plain, wrong),
                              cleared_wrong = score(cleared, wrong);
    for (const char* name : {"viscous_drag", "coriolis", "wake_shielding", "flow_drift"}) {
      const std::size_t at = entry_named(plain, name);
      const double moved = plain_wrong[at] - plain_right[at];
      const double left = cleared_wrong[at] - cleared_right[at];
      EXPECT_GT(std::fabs(moved), 0.5) << path << ", " << name;
      EXPECT_LT(std::fabs(left), 0.5 * std::fabs(moved)) << path << ", " << name;
    }
  }
}

// Same recordings, same bits.
TEST(Scores, AreRepeatable) {
  const Model model = drifting(5);
  const auto recordings = filmed(model, 8, 2);
  const ScorePlan plan = plan_for(model, recordings);
  EXPECT_EQ(score(plan, recordings), score(plan, recordings));
  EXPECT_EQ(score(plan, recordings).size(), plan.entries().size());
}

TEST(EmpiricalForce, FollowsItsCurve) {
  const Model model = drifting(1);
  MovingBodies body(1, 0, 1, 0);
  body.x = {0.05}, body.y = {0}, body.c = {1}, body.s = {0};
  body.vx = {0}, body.vy = {0}, body.omega = {0};
  // Radius from 0 to 0.1 m: 0.05 m lies in the middle of the third and fourth values.
  ActiveForce f = with_defaults(*find_force("empirical_force"));
  f.p = {0, 2, 0, 0.1, 0, 0, 1e-3, 3e-3, 0, 0};
  std::vector<Wrench> w(1);
  f.term->add(model, body.view(), {}, f.p, w);
  EXPECT_NEAR(w[0].fx, 2e-3, 1e-12);
  EXPECT_NEAR(w[0].fy, 0, 1e-12);
  // A torque over the heading closes on itself: half way from the last value to the first.
  f.p = {1, 8, -kPi, kPi, 2e-5, 0, 0, 0, 0, 4e-5};
  const Rot r = rotation(kPi - kPi / 6);
  body.c = {r.c}, body.s = {r.s};
  w.assign(1, Wrench{});
  f.term->add(model, body.view(), {}, f.p, w);
  EXPECT_NEAR(w[0].torque, 3e-5, 1e-12);
}

TEST(EmpiricalForce, PairsPushEachOtherEqually) {
  const Model model = drifting(2);
  MovingBodies two(2, 0, 1, 0);
  two.x = {0, 0.06}, two.y = {0, 0}, two.c = {1, 1}, two.s = {0, 0}, two.omega = {0, 0};
  ActiveForce f = with_defaults(*find_force("empirical_force"));
  f.p = {7, 2, 0, 0.05, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3};
  std::vector<Wrench> w(2);
  f.term->add(model, two.view(), {}, f.p, w);
  EXPECT_NEAR(w[0].fx, -1e-3, 1e-12);  // apart
  EXPECT_NEAR(w[1].fx, 1e-3, 1e-12);
}

TEST(FlowSlack, IsASmallSmoothErrorThatTheSeedFixes) {
  const Model model = drifting(1);
  const FlowField& field = *model.field;
  const FlowMaps maps(model.field);
  const auto a = perturbed_flow(maps, 9, 4, 0), again = perturbed_flow(maps, 9, 4, 0),
             other = perturbed_flow(maps, 9, 4, 1);
  double size = 0, error = 0;
  for (std::size_t i = 0; i < field.samples().size(); ++i) {
    const FlowSample &was = field.samples()[i], &is = a->samples()[i];
    EXPECT_EQ(is.mu_x, again->samples()[i].mu_x);
    size += was.mu_x * was.mu_x + was.mu_y * was.mu_y;
    error +=
        (is.mu_x - was.mu_x) * (is.mu_x - was.mu_x) + (is.mu_y - was.mu_y) * (is.mu_y - was.mu_y);
  }
  EXPECT_GT(std::sqrt(error / size), 0.01);
  EXPECT_LT(std::sqrt(error / size), 0.08);
  EXPECT_NE(a->samples()[1200].mu_x, other->samples()[1200].mu_x);
}

}  // namespace
}  // namespace lilytank
