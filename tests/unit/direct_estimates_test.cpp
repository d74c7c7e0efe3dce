// What recordings show directly of effects: amplitudes, places, ranges and frequencies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "finder/scan.hpp"
#include "finder/show.hpp"
#include "forces/library.hpp"
#include "lilytank/model_parameter.hpp"
#include "scores/nuisances.hpp"
#include "scores/scores.hpp"
#include "support/filmed.hpp"
#include "support/uncertain_maps.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

using test::drifting;
using test::filmed;
using test::plan_for;

Effect somewhere(const Model& model, const std::string& name, double x, double y, double width) {
  const std::vector<Effect> catalogue = effect_catalogue(model);
  const auto one = std::find_if(catalogue.begin(), catalogue.end(),
                                [&](const Effect& e) { return e.name == name; });
  return placed(*one, x, y, width);
}
Effect stream_at(const Model& model, double x, double y, double width) {
  return somewhere(model, "local_flow", x, y, width);
}

// A stream is found where it is, between places of the grid, which are 5 cm apart, at its strength.
TEST(Scores, TellThePlaceOfAStream) {
  const Model model = drifting(8);
  Effect stream = stream_at(model, -0.05, 0.12, 0.06);
  const auto recordings = filmed(with_effect(model, stream, {0.12, -0.06}), 60, 5);
  const FoundPlace found = find_place(plan_for(model, recordings), stream, recordings, 1).best;
  EXPECT_LT(std::hypot(found.x + 0.05, found.y - 0.12), 0.012);
  EXPECT_NEAR(found.amplitudes[0], 2, 0.15);  // in sizes of 6 cm/s
  EXPECT_NEAR(found.amplitudes[1], -1, 0.15);
}

// A disc of stronger drag likewise; it is no stream.
TEST(Scores, TellThePlaceOfAPatch) {
  const Model model = drifting(12);
  const Effect patch = somewhere(model, "drag_patch", -0.1, 0.08, 0.06);
  const auto recordings = filmed(with_effect(model, patch, {1.5}), 60, 5);
  ScorePlan plan = plan_for(model, recordings);
  plan.nuisances = std::make_shared<const Nuisances>(model, FlowMaps(model.field), 3);
  const PlaceScan scan = find_place(plan, patch, recordings, 1);
  const FoundPlace& found = scan.best;
  EXPECT_LT(std::hypot(found.x + 0.1, found.y - 0.08), 0.03);
  EXPECT_NEAR(found.amplitudes[0], 5, 1.25);  // in sizes of 0.3
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
    plan.nuisances = std::make_shared<const Nuisances>(model, FlowMaps(model.field), 3);
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
  known.nuisances = std::make_shared<const Nuisances>(model, FlowMaps(model.field), 3);
  ScorePlan hardly_known = known;
  hardly_known.nuisances =
      std::make_shared<const Nuisances>(model, test::uncertain_maps(*model.field, 0.025, 0.15), 3);
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
  EXPECT_LT(deviance_of(with, recordings), deviance_of(known, recordings) - 800);
}

// Larger drag makes the predictor expect more scatter from gusts, smaller drag less: neither is as
// likely as the true one.
TEST(Scores, PreferTheTrueDrag) {
  const Model model = drifting(12);
  const auto recordings = filmed(model, 60, 5);
  const std::vector<std::string> paths{"forces.face_drag.K_F"};
  const double K_F = parameter_value(model, paths[0]);
  const auto deviance = [&](double factor) {
    const Model other = with_parameters(model, paths, std::vector{factor * K_F});
    return deviance_of(plan_for(other, recordings), recordings);
  };
  EXPECT_LT(deviance(1), deviance(1.3) - 20);
  EXPECT_LT(deviance(1), deviance(0.7) - 20);
}

// A right stream beside a K_v that is too large loses one step ahead; allowing for that it is
// likelier than nothing. One that flows the other way is not.
TEST(Show, ARightEffectIsToldFromErrorsOfParameters) {
  const Model model = drifting(12);
  const Effect stream = stream_at(model, 0.05, 0.05, 0.04);
  const auto recordings = filmed(with_effect(model, stream, {0.06, 0}), 30, 5);
  ScorePlan plan = plan_for(model, recordings);
  plan.nuisances = std::make_shared<const Nuisances>(model, FlowMaps(model.field), 3);
  const std::vector<std::string> paths{"flow.K_v"};
  const Model off = with_parameters(model, paths, std::vector{1.06 * model.flow.K_v});
  const Model right = with_effect(off, stream, {0.06, 0});
  EXPECT_LT(step_gain(model, right, plan.predictor, recordings).high, 0);
  EXPECT_TRUE(likelier_but_for_errors(plan, right, recordings));
  EXPECT_FALSE(likelier_but_for_errors(plan, with_effect(off, stream, {-0.06, 0}), recordings));
}

// Eddies scatter modules and leave the expected step as it is, so predictions cannot test them.
TEST(Show, EddiesHaveNoGainOneStepAhead) {
  const Model model = drifting(12);
  const auto recordings = filmed(model, 10, 5);
  const ScorePlan plan = plan_for(model, recordings);
  const auto gain = [&](const std::string& path, double value) {
    const Model other =
        with_parameters(model, std::vector<std::string>{path}, std::vector<double>{value});
    return step_gain(model, other, plan.predictor, recordings).gain;
  };
  EXPECT_NEAR(gain("forces.correlated_gusts.share", 0.6), 0, 0.01);
  EXPECT_GT(std::fabs(gain("flow.K_v", 1.05 * model.flow.K_v)), 1);
  EXPECT_GT(std::fabs(gain("forces.flow_pulsation.share", 0.1)), 1);
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
  const auto estimates = joint_amplitudes(plan_for(model, recordings), recordings, {wall});
  const double truth = 7e-3 / wall.sizes[0];
  EXPECT_NEAR(estimates[0].estimate(0), truth, 0.15 * truth);
}

// An effect far beyond the size at which it is tried, all its components together; hardly anything
// of one that is not there.
TEST(Scores, TellStrongEffectsByTheirComponentsTogether) {
  const Model model = drifting(15);
  const Effect stream = stream_at(model, -0.05, 0.12, 0.09);
  const auto recordings = filmed(with_effect(model, stream, {0.18, -0.12}), 60, 5);
  const Effect elsewhere = stream_at(model, 0.1, -0.12, 0.05);
  const auto estimates =
      joint_amplitudes(plan_for(model, recordings), recordings, {stream, elsewhere});
  ASSERT_EQ(estimates.size(), 2u);
  EXPECT_NEAR(estimates[0].estimate(0), 3, 0.6);  // in sizes of 6 cm/s
  EXPECT_NEAR(estimates[0].estimate(1), -2, 0.4);
  EXPECT_GT(estimates[0].gain, 20 * std::max(1.0, estimates[1].gain));
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

}  // namespace
}  // namespace lilytank
