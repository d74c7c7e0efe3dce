// Scores beside a flow map with errors.
#include "scores/nuisances.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/random.hpp"
#include "scores/flow_uncertainty.hpp"
#include "scores/scores.hpp"
#include "support/filmed.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

using test::drifting;
using test::filmed;
using test::plan_for;

constexpr std::uint64_t kSeed = 3;

// Maps of a flow whose errors are independent over a few centimetres.
FlowMaps uncertain_maps(const FlowField& field) {
  constexpr int kDraws = 300, kBumps = 60;
  constexpr double kWidth = 0.04, kError = 0.015;  // m, m/s
  const double pitch = 2 * field.extent() / field.cells();
  std::vector<FlowDifference> draws;
  for (int d = 0; d < kDraws; ++d) {
    FlowDifference one(field.samples().size());
    for (int k = 0; k < kBumps; ++k) {
      const auto number = static_cast<std::uint32_t>(k);
      const auto size = normal_pair({kSeed, Stream::calibrate, d, number, 1});
      const double px = 0.6 * uniform({kSeed, Stream::calibrate, d, number, 2}) - 0.3;
      const double py = 0.6 * uniform({kSeed, Stream::calibrate, d, number, 3}) - 0.3;
      for (std::size_t i = 0; i < one.size(); ++i) {
        const auto wide = static_cast<std::size_t>(field.cells());
        const double x = (static_cast<double>(i % wide) + 0.5) * pitch - field.extent() - px;
        const double y = (static_cast<double>(i / wide) + 0.5) * pitch - field.extent() - py;
        const double share = std::exp(-0.5 * (x * x + y * y) / (kWidth * kWidth));
        one[i].mu_x += kError * size[0] * share, one[i].mu_y += kError * size[1] * share;
      }
    }
    draws.push_back(std::move(one));
  }
  const std::vector<FlowDifference> no_bias{FlowDifference(field.samples().size())};
  return {field, no_bias, std::move(draws)};
}

// Errors of the flow map look like a force in the frame of the tank, and like streams, to scores
// that are not cleared of them. The square of a cleared score over its variance is some 1; products
// of sensitivities are summed in few frames, and errors beyond the components remain.
TEST(Nuisances, ClearScoresOfErrorsOfTheFlowMap) {
  const Model model = drifting(12);
  const FlowMaps maps = uncertain_maps(*model.field);
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
  const FlowMaps maps = uncertain_maps(*model.field);
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
