// The baseline as a predictor, and what its innovations say of forces that it lacks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "finder/scan.hpp"
#include "finder/show.hpp"
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

Effect somewhere(const Model& model, const std::string& name, double x, double y, double width) {
  const std::vector<Effect> catalogue = effect_catalogue(model);
  const auto one = std::find_if(catalogue.begin(), catalogue.end(),
                                [&](const Effect& e) { return e.name == name; });
  return placed(*one, x, y, width);
}
Effect stream_at(const Model& model, double x, double y, double width) {
  return somewhere(model, "local_flow", x, y, width);
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
  plan.nuisances_known = nuisances_known(model, FlowMaps(model.field), 3);
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
  cleared.nuisances_known = nuisances_known(model, FlowMaps(model.field), 3);
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

// A stream is found where it is, at its strength; the grid of places is 5 cm wide.
TEST(Scores, TellThePlaceOfAStream) {
  const Model model = drifting(8);
  Effect stream = stream_at(model, -0.05, 0.12, 0.06);
  const auto recordings = filmed(with_effect(model, stream, {0.12, -0.06}), 60, 5);
  const FoundPlace found = find_place(plan_for(model, recordings), stream, recordings, 1).best;
  EXPECT_LT(std::hypot(found.x + 0.05, found.y - 0.12), 0.05);
  EXPECT_NEAR(found.amplitudes[0], 2, 1);  // in sizes of 6 cm/s
  EXPECT_NEAR(found.amplitudes[1], -1, 1);
}

// A disc of stronger drag likewise; it is no stream.
TEST(Scores, TellThePlaceOfAPatch) {
  const Model model = drifting(12);
  const Effect patch = somewhere(model, "drag_patch", -0.1, 0.08, 0.06);
  const auto recordings = filmed(with_effect(model, patch, {1.5}), 60, 5);
  ScorePlan plan = plan_for(model, recordings);
  plan.nuisances_known = nuisances_known(model, FlowMaps(model.field), 3);
  const PlaceScan scan = find_place(plan, patch, recordings, 1);
  const FoundPlace& found = scan.best;
  EXPECT_LT(std::hypot(found.x + 0.1, found.y - 0.08), 0.03);
  EXPECT_NEAR(found.amplitudes[0], 5, 2);  // in sizes of 0.3
  const FoundPlace stream = find_place(plan, stream_at(model, 0, 0, 0.06), recordings, 1).best;
  EXPECT_GT(found.gain, stream.gain + 100);
  // The map over the tank peaks there.
  const auto peak = std::ranges::max_element(scan.map, {}, &FoundPlace::gain);
  EXPECT_LT(std::hypot(peak->x + 0.1, peak->y - 0.08), 0.05);
}

// Linear estimates about all places, of every effect that has one: those of a patch are clearest
// about it, those of a tank without one are as chance has them.
TEST(Scores, TellThatNoPlaceIsOdd) {
  const Model model = drifting(12);
  const Effect patch = somewhere(model, "drag_patch", -0.1, 0.08, 0.06);
  const auto clearest = [&](double strength) {
    const auto recordings = filmed(with_effect(model, patch, {strength}), 60, 5);
    ScorePlan plan = plan_for(model, recordings);
    plan.effects = effect_catalogue(model);
    plan.nuisances_known = nuisances_known(model, FlowMaps(model.field), 3);
    std::pair<std::string, FoundPlace> out;
    for (const LinearPlaces& of : linear_places(plan, recordings)) {
      EXPECT_GT(of.places.size(), 80u) << of.effect->name;
      for (const FoundPlace& place : of.places) {
        if (place.gain > out.second.gain) out = {of.effect->name, place};
      }
    }
    return out;
  };
  const auto [name, place] = clearest(1.5);
  EXPECT_EQ(name, "drag_patch");
  EXPECT_LT(std::hypot(place.x + 0.1, place.y - 0.08), 0.05);
  EXPECT_GT(place.gain, 100);
  // The largest of 91 places with one amplitude and 91 with two.
  EXPECT_LT(clearest(0).second.gain, 20);
}

// A smooth error of the flow can do nearly all that a wide stream does: the place is known to the
// grid's 3 cm where the flow is known, and to the stream's width where it hardly is.
TEST(Scores, TellThePlaceOfAStrongWideStream) {
  constexpr double kWidth = 0.085;
  const Model model = drifting(12);
  const Effect stream = stream_at(model, 0.13, 0.08, kWidth);
  const auto recordings = filmed(with_effect(model, stream, {-0.12, -0.06}), 60, 11);
  ScorePlan known = plan_for(model, recordings);
  known.nuisances_known = nuisances_known(model, FlowMaps(model.field), 3);
  ScorePlan hardly_known = known;
  hardly_known.nuisances_known.bottomRightCorner(90, 90) *= 1e-3;  // of the flow's polynomials
  const auto expect = [&](const ScorePlan& plan, double off, double share, double gain) {
    const FoundPlace found = find_place(plan, stream, recordings, 1).best;
    EXPECT_LT(std::hypot(found.x - 0.13, found.y - 0.08), off);
    EXPECT_NEAR(found.amplitudes[0], -2, 2 * share);  // in sizes of 6 cm/s
    EXPECT_NEAR(found.amplitudes[1], -1, share);
    EXPECT_GT(found.gain, gain);
  };
  expect(known, 0.03, 0.15, 800), expect(hardly_known, kWidth, 0.45, 50);
  // With it in the model the recordings are as the predictor expects, but for what it leaves out.
  ScorePlan with = known;
  with.model = with_effect(model, stream, {-0.12, -0.06});
  EXPECT_LT(misfit_of(with, recordings), misfit_of(known, recordings) - 800);
}

// A right stream beside a K_v that is too large loses one step ahead; allowing for that it is
// likelier than nothing. One that flows the other way is not.
TEST(Show, ARightEffectIsToldFromErrorsOfParameters) {
  const Model model = drifting(12);
  const Effect stream = stream_at(model, 0.05, 0.05, 0.04);
  const auto recordings = filmed(with_effect(model, stream, {0.06, 0}), 30, 5);
  ScorePlan plan = plan_for(model, recordings);
  plan.nuisances_known = nuisances_known(model, FlowMaps(model.field), 3);
  const std::vector<std::string> paths{"flow.K_v"};
  const Model off = with_parameters(model, paths, std::vector{1.06 * model.flow.K_v});
  const Model right = with_effect(off, stream, {0.06, 0});
  EXPECT_LT(step_gain(model, right, plan.predictor, recordings).high, 0);
  EXPECT_TRUE(likelier_but_for_errors(plan, right, recordings));
  EXPECT_FALSE(likelier_but_for_errors(plan, with_effect(off, stream, {-0.06, 0}), recordings));
}

// The range of a force between modules to a factor of two, and its sign; none where there is none.
TEST(Scores, TellTheRangeOfAForceBetweenModules) {
  const Model model = drifting(15);
  const std::vector<std::string> paths{"forces.pair_repulsion.strength",
                                       "forces.pair_repulsion.range"};
  const auto repelled =
      filmed(with_parameters(model, paths, std::vector<double>{8e-3, 0.02}), 60, 5);
  const auto found = find_values(plan_for(model, repelled), repelled);
  ASSERT_EQ(found.count(&pair_attraction()), 1u);
  EXPECT_LT(found.at(&pair_attraction()).amplitude, 0);
  EXPECT_NEAR(std::log(found.at(&pair_attraction()).value / 0.02), 0, std::log(2.0));
  const auto nothing = filmed(model, 60, 5);
  EXPECT_EQ(find_values(plan_for(model, nothing), nothing).count(&pair_attraction()), 0u);
}

// Modules that a wall attracts lie at it, and it holds them: counting these, the force would seem
// to be a third of what it is.
TEST(Scores, TellAWallThatAttractsModulesThoughItHoldsThem) {
  Model model = drifting(15);
  model.flow.K_v = 0.3;  // or pumps would keep modules off the wall
  const std::vector<Effect> catalogue = effect_catalogue(model);
  Effect wall = *std::find_if(catalogue.begin(), catalogue.end(),
                              [](const Effect& e) { return e.name == "wall_force"; });
  wall.held[0].value = 0.03;
  const auto recordings = filmed(with_effect(model, wall, {7e-3}), 120, 5);
  const auto told = joint_amplitudes(plan_for(model, recordings), recordings, {wall});
  const double truth = 7e-3 / wall.sizes[0];
  EXPECT_NEAR(told[0].estimate(0), truth, 0.15 * truth);
}

// An effect far beyond the size at which it is tried, all its components together; hardly anything
// of one that is not there.
TEST(Scores, TellStrongEffectsByTheirComponentsTogether) {
  const Model model = drifting(15);
  const Effect stream = stream_at(model, -0.05, 0.12, 0.09);
  const auto recordings = filmed(with_effect(model, stream, {0.18, -0.12}), 60, 5);
  const Effect elsewhere = stream_at(model, 0.1, -0.12, 0.05);
  const auto told = joint_amplitudes(plan_for(model, recordings), recordings, {stream, elsewhere});
  ASSERT_EQ(told.size(), 2u);
  EXPECT_NEAR(told[0].estimate(0), 3, 0.6);  // in sizes of 6 cm/s
  EXPECT_NEAR(told[0].estimate(1), -2, 0.4);
  EXPECT_GT(told[0].gain, 20 * std::max(1.0, told[1].gain));
}

// The frequency of vortices to a tenth; none where there are none.
TEST(Scores, TellTheFrequencyOfVortices) {
  const Model model = drifting(15);
  const std::vector<std::string> paths{"forces.vortex_shedding.coefficient",
                                       "forces.vortex_shedding.frequency"};
  const auto shedding =
      filmed(with_parameters(model, paths, std::vector<double>{1.2, 1.13}), 60, 5);
  ScoreDetails found;
  score(plan_for(model, shedding), shedding, &found);
  EXPECT_NEAR(found.swinging, 1.13, 0.1);
  const auto nothing = filmed(model, 60, 5);
  score(plan_for(model, nothing), nothing, &found);
  EXPECT_EQ(found.swinging, 0);
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
