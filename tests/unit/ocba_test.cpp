// Optimal computing budget allocation against Chen's formulas, and against equal allocation.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "lilytank/random.hpp"
#include "lilytank/search.hpp"

namespace lilytank {
namespace {

// Best 1 (s = 1); the others at distances 1 and 2 with s = 2 and 1: ratios 4 and 1/4, and
// N_b = 1 sqrt(16 / 4 + (1/16) / 1) = sqrt(65/16).
TEST(Ocba, TargetsFollowChensRatios) {
  const OcbaCandidate candidates[] = {{1, 1, 10}, {2, 2, 10}, {3, 1, 10}};
  const auto target = ocba_targets(candidates, 70);
  const double sum = 4 + 0.25 + std::sqrt(65.0 / 16);
  EXPECT_NEAR(target[0], 100 * std::sqrt(65.0 / 16) / sum, 1e-9);
  EXPECT_NEAR(target[1], 100 * 4 / sum, 1e-9);
  EXPECT_NEAR(target[2], 100 * 0.25 / sum, 1e-9);
}

TEST(Ocba, SharesBringCandidatesToTheirTargets) {
  const OcbaCandidate candidates[] = {{1, 1, 10}, {2, 2, 10}, {3, 1, 10}};
  const auto shares = ocba_shares(candidates, 70);
  // The third has had more than its target; the other two share the rest in the ratio of theirs.
  EXPECT_EQ(shares[2], 0);
  EXPECT_EQ(shares[0] + shares[1], 70);
  const double ratio = std::sqrt(65.0 / 16) / 4;
  EXPECT_NEAR((10 + shares[0]) / (10.0 + shares[1]), ratio, 0.02);
}

TEST(Ocba, SharesAlwaysSumToTheBudget) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<OcbaCandidate>> lots = {
      {{1, 0, 3}, {2, 0, 3}},               // no noise
      {{1, 1, 3}, {1, 1, 3}, {1, 1, 3}},    // equal means
      {{inf, 1, 3}, {1, 1, 3}, {2, 1, 3}},  // one that failed
      {{inf, 1, 3}, {inf, 1, 3}},           // all that failed
      {{5, 1, 1}},                          // alone
      {{1, 1e-9, 1}, {1e9, 1, 1}, {2, 5, 100}},
  };
  for (const auto& candidates : lots) {
    for (const int extra : {0, 1, 7, 100}) {
      const auto shares = ocba_shares(candidates, extra);
      EXPECT_EQ(std::accumulate(shares.begin(), shares.end(), 0), extra);
      for (std::size_t i = 0; i < shares.size(); ++i) {
        EXPECT_GE(shares[i], 0);
        const bool failed = !std::isfinite(candidates[i].mean);
        EXPECT_TRUE(!failed || shares[i] == 0 || !std::isfinite(candidates.back().mean));
      }
    }
  }
}

/// Ten candidates with means 0, 1, ... 9 and noise of deviation 6: values of a seed.
double value_of(std::uint64_t seed, int candidate, int evaluation) {
  return candidate + 6 * normal_pair({seed, Stream::start_pose, evaluation,
                                      static_cast<std::uint32_t>(candidate)})[0];
}

/// Whether the lowest mean is candidate 0's after 10 evaluations each and 100 more in five stages.
bool selects_the_best(std::uint64_t seed, bool by_ocba) {
  constexpr int kCandidates = 10;
  double sum[kCandidates] = {}, squares[kCandidates] = {};
  int count[kCandidates] = {};
  const auto evaluate = [&](int c, int times) {
    for (int t = 0; t < times; ++t) {
      const double value = value_of(seed, c, count[c]++);
      sum[c] += value, squares[c] += value * value;
    }
  };
  for (int c = 0; c < kCandidates; ++c) evaluate(c, 10);
  for (int stage = 0; stage < 5; ++stage) {
    std::vector<OcbaCandidate> now;
    for (int c = 0; c < kCandidates; ++c) {
      const double mean = sum[c] / count[c];
      now.push_back({mean, std::sqrt(squares[c] / count[c] - mean * mean), count[c]});
    }
    const auto shares = by_ocba ? ocba_shares(now, 20) : std::vector<int>(kCandidates, 2);
    for (int c = 0; c < kCandidates; ++c) evaluate(c, shares[static_cast<std::size_t>(c)]);
  }
  for (int c = 1; c < kCandidates; ++c) {
    if (sum[c] / count[c] < sum[0] / count[0]) return false;
  }
  return true;
}

TEST(Ocba, SelectsTheBestMoreOftenThanEqualShares) {
  int ocba = 0, equal = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    ocba += selects_the_best(seed, true) ? 1 : 0;
    equal += selects_the_best(seed, false) ? 1 : 0;
  }
  // About 16 standard errors of a share of 1000 lie between nothing and everything here.
  EXPECT_GT(ocba, equal + 4 * 16);
}

}  // namespace
}  // namespace lilytank
