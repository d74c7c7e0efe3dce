// Statistics of innovations by the module, the place and the slip.
#include "scores/residual_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/filmed.hpp"

namespace lilytank {
namespace {

// Of two modules, halfway to the wall and in the centre, in so many frames each; innovations have
// the expected size, but `centre` times it in the centre. By name.
std::map<std::string, double> statistics(int frames, int in_centre, double centre,
                                         bool latched = false) {
  ScorePlan plan;
  plan.model = test::drifting(2), plan.modules = 2;
  plan.model.control.latches = latched;
  const double x[] = {0.5 * plan.model.tank.radius, 0}, y[] = {0, 0}, zero[] = {0, 0};
  PredictedFrame frame;
  frame.model = &plan.model, frame.interval = 1.0 / 30;
  frame.now = {
      .x = x, .y = y, .c = zero, .s = zero, .vx = zero, .vy = zero, .omega = zero, .modules = 2};
  std::map<std::string, double> out;
  for (const auto& part : residual_statistics(plan)) {
    const std::string first = part->entries().front().name;
    if (first != "variance" && first != "scatter, most") continue;
    for (frame.frame = 0; frame.frame < frames; ++frame.frame) {
      const double sign = frame.frame % 2 == 0 ? 1 : -1;
      const Seen away{.module = 0, .index = 0, .usable = true, .zx = sign, .zy = sign, .zt = sign};
      Seen inside = away;
      inside.module = inside.index = 1, inside.usable = frame.frame < in_centre;
      inside.zx *= centre, inside.zy *= centre;
      part->add(frame, {away, inside});
    }
    std::vector<double> values;
    part->append_to(values, nullptr);
    const std::vector<ScoreEntry> entries = part->entries();
    for (std::size_t k = 0; k < values.size(); ++k) out[entries[k].name] = values[k];
  }
  return out;
}

// One frame at a place says nothing of the noise there, hundreds do.
TEST(ResidualStatistics, CountTheVarianceAtAPlaceByItsVisits) {
  EXPECT_LT(statistics(3000, 1, 1.3).at("variance at radius 1"), 1);
  EXPECT_GT(statistics(3000, 600, 1.3).at("variance at radius 1"), 8);
  EXPECT_EQ(statistics(3000, 0, 1.3).at("variance at radius 1"), 0);
}

// A module of an assembly may be predicted for seconds only: that its scatter differs says little.
TEST(ResidualStatistics, CountDifferencesOfLatchedModulesByTheirFrames) {
  const double difference = std::log(9.0);  // of the logarithms of the variances
  const auto both = statistics(3000, 3000, 3, true), few = statistics(3000, 10, 3, true);
  EXPECT_NEAR(both.at("scatter, spread"), difference / 2, 1e-9);
  EXPECT_NEAR(both.at("scatter, most"), difference / 2, 1e-9);
  // 10 of 1505 frames on average, a difference of 3000 / 3010 from the weighted mean.
  EXPECT_NEAR(few.at("scatter, most"), difference * 3000 / 3010 * std::sqrt(10 / 1505.0), 1e-9);
  EXPECT_GT(few.at("scatter, least"), -0.02);
  EXPECT_NEAR(statistics(3000, 10, 3).at("scatter, spread"), difference / 2, 1e-9);
}

}  // namespace
}  // namespace lilytank
