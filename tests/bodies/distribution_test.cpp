// A distribution over bodies by values with errors.
#include "bodies/distribution.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank::bodies {
namespace {

constexpr double kHalfWidth = 1.96;

FoundParameter value_of(double value, double error) {
  return {"k", "law.k", value, value - kHalfWidth * error, value + kHalfWidth * error, "1/s"};
}

std::vector<FoundParameter> drawn(std::int64_t run, int number, double deviation, double error) {
  std::vector<FoundParameter> out;
  for (int k = 0; k < number; ++k) {
    const auto [a, b] = normal_pair({1, Stream::camera, run, static_cast<std::uint32_t>(k), 0});
    out.push_back(value_of(3 + deviation * a + error * b, error));
  }
  return out;
}

// Of 400 sets of eight values, 95 % intervals contain the truth in 366 to 392 with a probability of
// 99.5 %. The mean's is cautious where the values scatter by no more than their errors.
TEST(Distribution, IntervalsContainTheMeanAndTheDeviationBetweenValues) {
  int mean = 0, deviation = 0;
  for (int run = 0; run < 400; ++run) {
    const Distribution d = distribution_of(drawn(run, 8, 0.5, 0.4));
    mean += d.mean_low <= 3 && 3 <= d.mean_high;
    deviation += d.deviation_low <= 0.5 && 0.5 <= d.deviation_high;
  }
  EXPECT_GE(mean, 366);
  EXPECT_GE(deviation, 366);
  EXPECT_LE(deviation, 392);
}

TEST(Distribution, EqualValuesHaveNoDeviation) {
  const std::vector<FoundParameter> same{value_of(2, 0.1), value_of(2, 0.2), value_of(2, 0.1)};
  const Distribution d = distribution_of(same);
  EXPECT_DOUBLE_EQ(d.mean, 2);
  EXPECT_EQ(d.deviation, 0);
  EXPECT_EQ(d.deviation_low, 0);
  EXPECT_GT(d.mean_high, 2.1);
}

// Eight values that grow with the square of their size, with errors of 5 % and, in the second half,
// a scatter of 20 % beside them. Of 200 intervals 180 to 197 contain the truth with a probability
// of 99.5 %.
TEST(Distribution, AnExponentOverSizesHasItsInterval) {
  int within = 0;
  for (int run = 0; run < 200; ++run) {
    std::vector<double> sizes;
    std::vector<FoundParameter> values;
    for (int k = 0; k < 8; ++k) {
      const auto [a, b] = normal_pair({2, Stream::camera, run, static_cast<std::uint32_t>(k), 0});
      const double size = 0.02 * std::pow(1.2, k), scatter = run < 100 ? 0 : 0.2;
      const double law = -3 * size * size;
      sizes.push_back(size);
      values.push_back(value_of(law * (1 + scatter * a + 0.05 * b), 0.05 * std::fabs(law)));
    }
    const auto growth = growth_over(sizes, values);
    ASSERT_TRUE(growth);
    within += growth->low <= 2 && 2 <= growth->high;
  }
  EXPECT_GE(within, 180);
  EXPECT_LE(within, 197);
}

TEST(Distribution, ThereIsNoExponentOfLikeSizesOrUnknownOnes) {
  const std::vector<FoundParameter> values(4, value_of(2, 0.1));
  EXPECT_FALSE(growth_over(std::vector<double>{1, 1.1, 1.2, 1.3}, values));
  EXPECT_FALSE(growth_over(std::vector<double>{0, 0, 0, 0}, values));
  EXPECT_TRUE(growth_over(std::vector<double>{1, 2, 3, 4}, values));
}

TEST(Distribution, ManyValuesAreNotListed) {
  const std::vector<FoundParameter> listed = summarized(drawn(1, 12, 1, 0.1), 12, "runs");
  EXPECT_EQ(listed.size(), 14u);
  const std::vector<FoundParameter> of = summarized(drawn(1, 40, 1, 0.1), 40, "runs");
  ASSERT_EQ(of.size(), 5u);
  EXPECT_EQ(of[0].name, "k, median of 40 runs, 2.5 % to 97.5 % of them");
  EXPECT_EQ(of[3].name, "k, mean of 40 runs");
  EXPECT_NEAR(of[4].value, 1, 0.4);
}

}  // namespace
}  // namespace lilytank::bodies
