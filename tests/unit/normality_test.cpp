// Tests of normality, and of many hypotheses.
#include "lilytank/normality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

std::vector<double> normal_samples(int n, std::int64_t trial) {
  std::vector<double> out;
  for (int i = 0; i < n; ++i) {
    const auto pair = normal_pair({7, Stream::gust, trial, static_cast<std::uint32_t>(i), 0});
    out.push_back(3 + 0.2 * pair[0]);
  }
  return out;
}

class Sizes : public testing::TestWithParam<int> {};

// Under the null p is uniform: the largest difference of its distribution from that exceeds
// 1.95 / sqrt(trials) once in 1000. The table's own noise adds up to 0.003.
TEST_P(Sizes, probabilitiesOfNormalSamplesAreUniform) {
  constexpr int kTrials = 4000;
  std::vector<double> p;
  for (int t = 0; t < kTrials; ++t) p.push_back(test_normality(normal_samples(GetParam(), t)).p);
  std::sort(p.begin(), p.end());
  double apart = 0;
  for (int i = 0; i < kTrials; ++i) {
    apart = std::max(apart, std::fabs(p[static_cast<std::size_t>(i)] - (i + 0.5) / kTrials));
  }
  EXPECT_LT(apart, 1.95 / std::sqrt(kTrials) + 0.003);
  const auto below = std::lower_bound(p.begin(), p.end(), 0.05) - p.begin();
  EXPECT_NEAR(below / static_cast<double>(kTrials), 0.05, 4 * std::sqrt(0.05 * 0.95 / kTrials));
}
INSTANTIATE_TEST_SUITE_P(normality, Sizes, testing::Values(4, 5, 7, 12, 17, 40, 150));

TEST(normality, withoutLillieforsCorrectionItAlmostNeverRejects) {
  int raw = 0;
  for (int t = 0; t < 2000; ++t) raw += test_normality(normal_samples(30, t)).raw_p < 0.05 ? 1 : 0;
  EXPECT_LT(raw, 10);
}

TEST(normality, criticalValuesArePublishedOnes) {
  // Stephens (1974), scaled distances, from 10,000 samples: two digits of p.
  const double published[][2] = {{0.819, 0.10}, {0.895, 0.05}, {0.955, 0.025}, {1.035, 0.01}};
  for (const auto& [scaled, p] : published) {
    const double root = std::sqrt(20.0);
    EXPECT_NEAR(lilliefors_p(scaled / (root - 0.01 + 0.85 / root), 20) / p, 1, 0.12) << p;
  }
  EXPECT_NEAR(lilliefors_p(0.190, 20), 0.05, 0.01);  // Lilliefors (1967), 1000 samples
  // Kolmogorov's: 1.358 / sqrt(n), and 0.294 for n = 20.
  EXPECT_NEAR(kolmogorov_p(1.358 / std::sqrt(1e6), 1000000), 0.05, 0.0005);
  EXPECT_NEAR(kolmogorov_p(0.294, 20), 0.05, 0.002);
}

TEST(normality, otherDistributionsAreRejected) {
  std::vector<double> exponential, two_heaps;
  for (int i = 0; i < 200; ++i) {
    const double u = uniform({3, Stream::gust, i, 0, 0});
    exponential.push_back(-std::log(u));
    two_heaps.push_back((i % 2 == 0 ? -1 : 1) + 0.3 * normal_pair({3, Stream::gust, i, 1, 0})[0]);
  }
  EXPECT_LT(test_normality(exponential).p, 0.001);
  EXPECT_LT(test_normality(two_heaps).p, 0.001);
}

TEST(normality, littleOrNothingIsNeverRejected) {
  EXPECT_EQ(test_normality({}).p, 1);
  EXPECT_EQ(test_normality({1, 2, 3}).p, 1);
  const NormalityTest same = test_normality({2, 2, 2, 2, 2});
  EXPECT_EQ(same.p, 1);
  EXPECT_EQ(same.mean, 2);
  EXPECT_EQ(same.deviation, 0);
}

TEST(normality, distanceByHand) {
  // Mean 0, squares 2, deviation sqrt(2/3). The distribution function of the samples steps from 1/4
  // to 3/4 at 0, where the normal one is 1/2; at -1 it steps from 0 to 1/4 over Phi(-1.225) =
  // 0.110.
  const NormalityTest t = test_normality({-1, 0, 0, 1});
  EXPECT_NEAR(t.deviation, std::sqrt(2.0 / 3), 1e-15);
  EXPECT_NEAR(t.distance, 0.25, 1e-12);
}

// The worked example of Benjamini and Hochberg (1995, section 3.1): 15 hypotheses, 4 rejected.
TEST(falseDiscovery, rejectsTheFirstFourOfTheBloodClotStudy) {
  const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                              0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
  const auto rejected = false_discovery(p, 0.05);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(rejected[i], i < 4) << i;
}

TEST(falseDiscovery, whatWasNotTestedDoesNotCount) {
  const auto rejected = false_discovery({std::nan(""), 0.04, std::nan("")}, 0.05);
  EXPECT_EQ(rejected, (std::vector<bool>{false, true, false}));
  EXPECT_TRUE(false_discovery({}, 0.05).empty());
}

}  // namespace
}  // namespace lilytank
