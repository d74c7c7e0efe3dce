// The parts of CMA-ES against values by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "search/cma_distribution.hpp"
#include "search/eigen.hpp"
#include "search/rank_change.hpp"

namespace lilytank {
namespace {

TEST(CmaEs, EigenvectorsRebuildTheMatrix) {
  const int n = 5;
  std::vector<double> a(25), values, vectors;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) a[i * n + j] = 1.0 / (1 + i + j);  // Hilbert's: condition 5e5
  }
  symmetric_eigen(a, n, values, vectors);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      double rebuilt = 0, product = 0;
      for (int k = 0; k < n; ++k) {
        rebuilt += vectors[i * n + k] * values[k] * vectors[j * n + k];
        product += vectors[k * n + i] * vectors[k * n + j];
      }
      EXPECT_NEAR(rebuilt, a[i * n + j], 1e-14);
      EXPECT_NEAR(product, i == j, 1e-14);
    }
  }
}

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

TEST(CmaEs, FollowsASlope) {
  CmaDistribution distribution({0.5, 0.5}, 0.1, 6);
  const double before = distribution.spread();
  std::vector<std::vector<double>> ranked;
  for (int i = 0; i < 6; ++i) ranked.push_back({2.0 - i * 0.8, 0.1 * (i % 2)});
  for (int generation = 0; generation < 3; ++generation) distribution.update(ranked);
  EXPECT_GT(distribution.mean()[0], 0.6);
  EXPECT_GT(distribution.spread(), before);
  EXPECT_FALSE(distribution.worn_out());
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
