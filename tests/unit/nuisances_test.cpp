// Scores beside a flow map with errors.
#include "scores/nuisances.hpp"

#include <gtest/gtest.h>

#include "scores/flow_uncertainty.hpp"
#include "scores/scores.hpp"
#include "support/filmed.hpp"
#include "support/uncertain_maps.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

using test::drifting;
using test::filmed;
using test::plan_for;
using test::uncertain_maps;

constexpr std::uint64_t kSeed = 3;

// Errors of the flow map look like a force in the frame of the tank, and like streams, to scores
// that are not cleared of them. The square of a cleared score over its variance is some 1; products
// of sensitivities are summed in few frames, and errors beyond the components remain.
TEST(Nuisances, ClearScoresOfErrorsOfTheFlowMap) {
  const Model model = drifting(12);
  const FlowMaps maps = uncertain_maps(*model.field, 0.015);
  ScorePlan plan = plan_for(model, filmed(model, 30, 1));
  std::erase_if(plan.effects,
                [](const Effect& e) { return e.name != "body_force" && e.name != "local_flow"; });
  plan.shapes.clear();
  ScorePlan cleared = plan;
  cleared.nuisances = std::make_shared<const Nuisances>(model, maps, kSeed);
  const auto mean_square = [](const std::vector<Sensitivities::Amplitude>& all) {
    double sum = 0;
    for (const auto& one : all) sum += one.gain();
    return sum / static_cast<double>(all.size());
  };
  for (int run = 0; run < 3; ++run) {
    Model other = model;
    other.field = perturbed_flow(maps, 7, 8, run);
    const auto recordings = filmed(other, 60, 20 + static_cast<std::uint64_t>(run));
    EXPECT_GT(mean_square(scored_amplitudes(plan, recordings)), 20);
    EXPECT_LT(mean_square(scored_amplitudes(cleared, recordings)), 6);
  }
}

// Maps without the balls' errors leave less open.
TEST(Nuisances, AreBetterKnownByMoreBalls) {
  const Model model = drifting(5);
  const FlowMaps maps = uncertain_maps(*model.field, 0.015);
  const Nuisances nuisances(model, maps, kSeed);
  const Eigen::MatrixXd best = nuisances.known_for(FlowMaps(maps.best()), kSeed);
  const Eigen::Index flow = nuisances.count() - Nuisances::kParameters;
  const auto precision = [&](const Eigen::MatrixXd& of) {
    return of.bottomRightCorner(flow, flow).diagonal().mean();
  };
  EXPECT_NEAR(precision(nuisances.known()), 1, 1e-9);
  EXPECT_GT(precision(best), 5);
  EXPECT_TRUE(best.topLeftCorner(Nuisances::kParameters, Nuisances::kParameters).isIdentity(1e-9));
}

// Same seed, same bits, for any number of threads.
TEST(Nuisances, AreRepeatable) {
  const Model model = drifting(5);
  const auto recordings = filmed(model, 8, 2);
  ScorePlan plan = plan_for(model, recordings);
  const auto values = [&](int threads) {
    plan.nuisances =
        std::make_shared<const Nuisances>(model, FlowMaps(model.field), kSeed, threads);
    return score(plan, recordings);
  };
  EXPECT_EQ(values(1), values(2));
}

}  // namespace
}  // namespace lilytank
