// Parameters' errors as predictions one frame ahead show them.
#include "scores/prediction_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/emulator.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {
namespace {

Model tank() {
  return load_scenario({LILYTANK_SOURCE_DIR "/scenarios/tank_lilies.toml"}, {}).model;
}

std::vector<Recording> filmed(const Model& model, std::uint64_t seed) {
  RecordingShape shape;
  shape.bodies = 15, shape.frames = 2400, shape.rate = 10, shape.name = "lily";
  const auto made = Emulator(model, {}, {shape}).record({}, seed);
  return made ? *made : std::vector<Recording>{};
}

// Change of `number` where the parameter at `path` is `factor` times that of the model that
// predicts, over the scatter of four minutes.
double response(const std::string& path, double factor, std::size_t number) {
  const Model model = tank();
  const Model other =
      with_parameters(model, std::vector{path}, std::vector{factor * parameter_value(model, path)});
  const ScorePlan plan = prediction_plan(model, filmed(model, 1), 15);
  constexpr int kTimes = 6;
  double before = 0, square = 0, after = 0;
  for (int k = 0; k < kTimes; ++k) {
    const double a = prediction_numbers(plan, filmed(model, 10 + static_cast<unsigned>(k)))[number];
    const double b = prediction_numbers(plan, filmed(other, 20 + static_cast<unsigned>(k)))[number];
    before += a / kTimes, after += b / kTimes, square += a * a / kTimes;
  }
  const double scatter =
      std::sqrt(std::max(square - before * before, 1e-12) * kTimes / (kTimes - 1));
  return (after - before) / (scatter * std::sqrt(2.0 / kTimes));
}

// Of five numbers that are in the order of their names.
TEST(PredictionNumbers, ShowWhichParameterIsAnother) {
  ASSERT_EQ(prediction_names().size(), 5u);
  ASSERT_EQ(prediction_names()[1], "change of flow");
  EXPECT_GT(response("flow.K_v", 1.6, 1), 4);
  EXPECT_LT(response("flow.K_v", 0.6, 1), -4);
}

TEST(PredictionNumbers, AreFiniteWhereHardlyAnythingIsSeen) {
  const Model model = tank();
  std::vector<Recording> recordings = filmed(model, 3);
  for (Track& track : recordings.front().tracks) {
    for (std::size_t i = 0; i < track.x.size(); ++i) {
      if (i % 40 < 38) track.x[i] = track.y[i] = track.theta[i] = std::nan("");
    }
  }
  const ScorePlan plan = prediction_plan(model, filmed(model, 1), 15);
  for (const double number : prediction_numbers(plan, recordings)) {
    EXPECT_TRUE(std::isfinite(number));
  }
}

}  // namespace
}  // namespace lilytank
