// The parts of CMA-ES against values by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lilytank/random.hpp"
#include "search/cma_distribution.hpp"
#include "search/rank_change.hpp"

namespace lilytank {
namespace {

// Hansen's tutorial: weights of the better half sum to 1, mu_eff = 1 / sum w^2, and with the
// defaults' negative weights all weights sum to about 0.
TEST(CmaEs, ConstantsAreTheTutorials) {
  const CmaConstants c(5, 8);
  double sum = 0, squares = 0, all = 0;
  for (int i = 0; i < 8; ++i) {
    if (i < 4) sum += c.weight[i], squares += c.weight[i] * c.weight[i];
    all += c.weight[i];
    EXPECT_TRUE(i == 0 || c.weight[i] < c.weight[i - 1]);
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_NEAR(1 / squares, c.mu_eff, 1e-12);
  EXPECT_NEAR(c.c_1, 2 / (6.3 * 6.3 + c.mu_eff), 1e-12);
  EXPECT_NEAR(c.c_sigma, (c.mu_eff + 2) / (5 + c.mu_eff + 5), 1e-12);
  EXPECT_LE(c.c_1 + c.c_mu, 1);
  EXPECT_NEAR(c.chi, std::sqrt(5) * (1 - 1.0 / 20 + 1.0 / 525), 1e-12);
  // Keeps the covariance positive: the decay of c_mu takes no more than what is there.
  EXPECT_GE(1 - c.c_1 - c.c_mu * all, 0);
}

// On a linear function the first update moves the mean by sigma times the weighted means of the
// order statistics of six normals, 1.2672, 0.6418 and 0.2015, and not at all across; later ones
// widen the distribution.
TEST(CmaEs, FollowsASlope) {
  constexpr int seeds = 1000;
  constexpr double sigma = 0.1, order_means[] = {1.2672, 0.6418, 0.2015};
  double along = 0, across = 0, growth = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    CmaDistribution distribution({0.5, 0.5}, sigma, 6);
    for (std::uint32_t generation = 0; generation < 5; ++generation) {
      std::vector<std::vector<double>> ranked;
      for (std::uint32_t i = 0; i < 6; ++i) {
        const auto z =
            normal_pair({static_cast<std::uint64_t>(seed), Stream::search, generation, i, 0});
        ranked.push_back({z[0], z[1]});
      }
      std::sort(ranked.begin(), ranked.end(), [&](const auto& a, const auto& b) {
        return distribution.sample(a)[0] > distribution.sample(b)[0];
      });
      distribution.update(ranked);
      if (generation > 0) continue;
      along += (distribution.mean()[0] - 0.5) / sigma / seeds;
      across += (distribution.mean()[1] - 0.5) / sigma / seeds;
    }
    growth += std::log(distribution.spread() / sigma) / seeds;
    EXPECT_FALSE(distribution.worn_out());
  }
  const std::vector<double> weight = CmaConstants(2, 6).weight;
  double expected = 0, squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    expected += weight[i] * order_means[i], squares += weight[i] * weight[i];
  }
  // Order statistics vary less than the normals whose weighted mean `across` is.
  const double four_errors = 4 * std::sqrt(squares / seeds);
  EXPECT_NEAR(along, expected, four_errors);
  EXPECT_NEAR(across, 0, four_errors);
  EXPECT_GT(growth, 0.1);
}

// Equal values twice: no rank changes. Values turned upside down: more than chance would do.
TEST(CmaEs, MeasuresHowNoiseChangesRanks) {
  EXPECT_LT(rank_change({1, 2, 3, 4, 5, 6, 7, 8}, {1.01, 2.01}), 0);
  EXPECT_GT(rank_change({1, 2, 3, 4, 5, 6, 7, 8}, {9, 8.5}), 0);
  // By hand: ranks 1 and 5 among {1, 2, 3, 4, 9}. Three lie between. Limits: the 0.1 quantiles of
  // |r - 4| and |r - 1| for r = 1 .. 4 are 0.3 each.
  EXPECT_NEAR(rank_change({1, 2, 3, 4}, {9}), 2 * 3 - 0.3 - 0.3, 1e-12);
}

}  // namespace
}  // namespace lilytank
