// Scores beside a flow map with errors.
#include "scores/nuisances.hpp"

#include <gtest/gtest.h>

#include <utility>

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

// The mean of the square of a score over its variance: 1 if nothing is missing and nothing is
// wrong with the model.
double mean_square(const ScorePlan& plan, const std::vector<Recording>& recordings) {
  const std::vector<Sensitivities::Amplitude> all = scored_amplitudes(plan, recordings);
  double sum = 0;
  for (const auto& one : all) sum += one.gain();
  return sum / static_cast<double>(all.size());
}

// Of streams and a constant force, by several recordings with these maps' errors; first not cleared
// of these.
std::pair<double, double> mean_squares(const FlowMaps& maps, const Model& model) {
  ScorePlan plan = plan_for(model, filmed(model, 30, 1));
  std::erase_if(plan.effects,
                [](const Effect& e) { return e.name != "body_force" && e.name != "local_flow"; });
  plan.shapes.clear();
  ScorePlan cleared = plan;
  cleared.nuisances = std::make_shared<const Nuisances>(model, maps, kSeed);
  constexpr int kRuns = 3;
  std::pair<double, double> out;
  for (int run = 0; run < kRuns; ++run) {
    Model other = model;
    other.field = perturbed_flow(maps, 7, 8, run);
    const auto recordings = filmed(other, 60, 20 + static_cast<std::uint64_t>(run));
    out.first += mean_square(plan, recordings) / kRuns;
    out.second += mean_square(cleared, recordings) / kRuns;
  }
  return out;
}

// Errors of the flow map look like a force in the frame of the tank, and like streams, to scores
// that are not cleared of them. Components found from draws leave errors beyond them.
TEST(Nuisances, ClearScoresOfErrorsOfTheFlowMap) {
  const Model model = drifting(12);
  const auto [raw, cleared] = mean_squares(uncertain_maps(*model.field, 0.015), model);
  EXPECT_GT(raw, 20);
  EXPECT_LT(cleared, 6);
}

// Known components leave what the filter's information says: the mean of 42 squares of a normal
// number is below 1.9 but for once in 1000 times, and products of sensitivities are summed in few
// frames.
TEST(Nuisances, ClearScoresOfAllErrorsOfKnownComponents) {
  const Model model = drifting(12);
  const auto [raw, cleared] = mean_squares(test::maps_with_components(*model.field, 0.015), model);
  EXPECT_GT(raw, 20);
  EXPECT_LT(cleared, 2);
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
