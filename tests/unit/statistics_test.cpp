// Each statistic against published values, closed forms and, where possible, exact enumeration.
#include "lilytank/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "statistics/quantiles.hpp"
#include "support/samples.hpp"

namespace lilytank {
namespace {

using namespace lilytank::test;

double binomial(int n, int k, double p) {
  return std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                  k * std::log(p) + (n - k) * std::log1p(-p));
}
double poisson(int k, double mean) {
  return std::exp(k * std::log(mean) - mean - std::lgamma(k + 1.0));
}

TEST(Wilson, MatchesPublishedValues) {
  // Newcombe, Stat. Med. 17 (1998) 857, Table I, method 3.
  struct Case {
    int hits, n;
    double low, high;
  };
  for (const Case& c : {Case{81, 263, 0.2553, 0.3662}, Case{15, 148, 0.0624, 0.1605},
                        Case{0, 20, 0.0000, 0.1611}, Case{1, 29, 0.0061, 0.1718}}) {
    const Estimate e = wilson(c.hits, c.n);
    EXPECT_DOUBLE_EQ(e.value, static_cast<double>(c.hits) / c.n);
    EXPECT_NEAR(e.low, c.low, 5.1e-5) << c.hits << "/" << c.n;
    EXPECT_NEAR(e.high, c.high, 5.1e-5) << c.hits << "/" << c.n;
  }
}

TEST(Wilson, EndsSolveTheScoreEquation) {
  for (const int n : {1, 7, 40, 1000}) {
    for (int hits = 0; hits <= n; hits += std::max(1, n / 7)) {
      const Estimate e = wilson(hits, n);
      for (const double end : {e.low, e.high}) {
        const double p = e.value;
        EXPECT_NEAR((p - end) * (p - end), kZ * kZ * end * (1 - end) / n, 1e-12);
      }
      EXPECT_LE(e.low, e.value);
      EXPECT_GE(e.high, e.value);
    }
  }
}

TEST(Wilson, CoversAsOftenAsItSaysOnAverage) {
  // Exact: the probability of all outcomes whose interval holds p. Brown, Cai and DasGupta, Stat.
  // Sci. 16 (2001) 101: near the level on average, with dips that stay above 0.83.
  for (const int n : {15, 40}) {
    double sum = 0, least = 1;
    const int grid = 999;
    for (int g = 1; g <= grid; ++g) {
      const double p = static_cast<double>(g) / (grid + 1);
      double coverage = 0;
      for (int k = 0; k <= n; ++k) {
        const Estimate e = wilson(k, n);
        if (e.low <= p && p <= e.high) coverage += binomial(n, k, p);
      }
      sum += coverage, least = std::min(least, coverage);
    }
    EXPECT_NEAR(sum / grid, 0.95, 0.01) << n;
    EXPECT_GT(least, 0.83) << n;
  }
}

TEST(Wilson, WithoutTrialsKnowsNothing) {
  const Estimate e = wilson(0, 0);
  EXPECT_TRUE(std::isnan(e.value));
  EXPECT_EQ(e.low, 0);
  EXPECT_EQ(e.high, 1);
  EXPECT_EQ(wilson(0, 9).low, 0);
  EXPECT_EQ(wilson(9, 9).high, 1);
  EXPECT_LT(wilson(3, 9, 0.99).low, wilson(3, 9, 0.9).low);
}

TEST(PoissonRate, MatchesClosedFormsAndTables) {
  EXPECT_NEAR(poisson_rate(0, 2).high, -std::log(0.025) / 2, 1e-12);
  EXPECT_EQ(poisson_rate(0, 2).low, 0);
  EXPECT_NEAR(poisson_rate(1, 1).low, -std::log(0.975), 1e-12);
  const Estimate ten = poisson_rate(10, 4);
  EXPECT_DOUBLE_EQ(ten.value, 2.5);
  EXPECT_NEAR(ten.low, 4.7954 / 4, 1e-4);
  EXPECT_NEAR(ten.high, 18.3904 / 4, 1e-4);
  const Estimate none = poisson_rate(0, 0);
  EXPECT_TRUE(std::isnan(none.value));
  EXPECT_EQ(none.high, kInf);
}

TEST(PoissonRate, NeverCoversLessThanItsLevel) {
  std::vector<Estimate> of;
  for (int k = 0; k < 80; ++k) of.push_back(poisson_rate(k, 1));
  for (double mean = 0.05; mean < 30; mean += 0.05) {
    double coverage = 0;
    for (int k = 0; k < 80; ++k) {
      if (of[k].low <= mean && mean <= of[k].high) coverage += poisson(k, mean);
    }
    EXPECT_GE(coverage, 0.95 - 1e-9) << mean;
  }
}

TEST(MeanInterval, IsStudents) {
  const Estimate e = mean_interval({1, 2, 3, 4, 5});
  EXPECT_DOUBLE_EQ(e.value, 3);
  EXPECT_NEAR(e.high - 3, 2.776445105 * std::sqrt(2.5 / 5), 1e-8);
  EXPECT_NEAR(3 - e.low, e.high - 3, 1e-12);
  EXPECT_EQ(mean_interval({4}).value, 4);
  EXPECT_EQ(mean_interval({4}).low, -kInf);
  EXPECT_EQ(mean_interval({4}).high, kInf);
  EXPECT_TRUE(std::isnan(mean_interval({}).value));
  const Estimate equal = mean_interval({0.1, 0.1, 0.1});
  EXPECT_NEAR(equal.high - equal.low, 0, 1e-15);
}

// Twenty tanks without a copy do not say that there is never one: 1 - 0.025^(1/20) = 0.168 of them
// may have up to three.
TEST(MeanInterval, OfEqualNumbersIsWhatSoFewLeavePossible) {
  const Estimate none = bounded_mean_interval(std::vector<double>(20, 0.0), 0, 3);
  EXPECT_EQ(none.value, 0);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 3 * 0.16843347, 1e-6);
  const Estimate all = bounded_mean_interval(std::vector<double>(20, 3.0), 0, 3);
  EXPECT_NEAR(all.low, 3 - 3 * 0.16843347, 1e-6);
  EXPECT_EQ(all.high, 3);
  const Estimate some = bounded_mean_interval({1, 2, 3, 4, 5}, 0, 5);
  EXPECT_EQ(some.high, mean_interval({1, 2, 3, 4, 5}).high);
  EXPECT_EQ(bounded_mean_interval({4}, 0, 5).high, kInf);
}

TEST(ComparePairs, MatchesStudentsOwnExample) {
  // Hours of sleep gained with two drugs, Student, Biometrika 6 (1908) 1: t = 4.0621 of 9.
  const std::vector<double> a = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
  const std::vector<double> b = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
  const PairedComparison c = compare_pairs(a, b);
  EXPECT_NEAR(c.difference.value, 1.58, 1e-12);
  EXPECT_NEAR(c.difference.low, 0.7001142, 1e-7);
  EXPECT_NEAR(c.difference.high, 2.4598858, 1e-7);
  EXPECT_NEAR(c.p, 0.002833, 5e-7);
  EXPECT_NEAR(c.saving, (4.009 + 3.200556) / 1.512889, 1e-5);
  EXPECT_NEAR(compare_pairs(b, a).difference.value, -1.58, 1e-12);
}

TEST(ComparePairs, SavesWhatTheCommonPartIsWorth) {
  // Common part of variance 1, own parts of 0.1: (1.1 + 1.1) / 0.2 = 11, known to 4 * sqrt(4 / n).
  std::vector<double> a, b;
  constexpr int n = 4000;
  for (int i = 0; i < n; ++i) {
    const auto common = normal_pair({7, Stream::evaluation, i, 0, 0});
    const auto own = normal_pair({7, Stream::evaluation, i, 1, 0});
    a.push_back(common[0] + std::sqrt(0.1) * own[0]);
    b.push_back(common[0] + std::sqrt(0.1) * own[1]);
  }
  EXPECT_NEAR(compare_pairs(a, b).saving / 11, 1, 4 * std::sqrt(4.0 / n));
}

TEST(ComparePairs, OfPairsWithoutSpread) {
  EXPECT_TRUE(std::isnan(compare_pairs({}, {}).p));
  EXPECT_TRUE(std::isnan(compare_pairs({3}, {1}).p)) << "one pair has no spread";
  EXPECT_TRUE(std::isnan(compare_pairs({3}, {1}).saving));
  EXPECT_EQ(compare_pairs({3}, {1}).difference.value, 2);
  EXPECT_EQ(compare_pairs({3}, {1}).difference.high, kInf);
  const PairedComparison same = compare_pairs({1, 2, 3}, {1, 2, 3});
  EXPECT_EQ(same.difference.value, 0);
  EXPECT_EQ(same.p, 1);
  EXPECT_EQ(same.saving, kInf);
  const PairedComparison shifted = compare_pairs({2, 3, 4}, {1, 2, 3});
  EXPECT_EQ(shifted.p, 0.25) << "one time in four, three signs are equal by chance";
  EXPECT_EQ(shifted.difference.low, 1);
  EXPECT_EQ(compare_pairs({2, 2}, {2, 2}).saving, 1);
}

TEST(YieldBand, MeanCountsStepsUpToAndAtEachTime) {
  const CurveBand band = yield_band({{1, 3}, {2}, {}, {1, 2, 3}}, {0, 1, 2, 2.5, 3, 9}, 1);
  EXPECT_EQ(band.mean, (std::vector<double>{0, 0.5, 1, 1, 1.5, 1.5}));
  EXPECT_EQ(band.low[0], 0);
  EXPECT_EQ(band.high[0], 0);
  for (std::size_t i = 0; i < band.time.size(); ++i) {
    EXPECT_LE(band.low[i], band.mean[i]);
    EXPECT_GE(band.high[i], band.mean[i]);
  }
}

TEST(YieldBand, IsAFunctionOfItsSeed) {
  std::vector<std::vector<double>> steps;
  for (int r = 0; r < 15; ++r) steps.push_back({exponential_at(8, r), 1 + exponential_at(9, r)});
  const std::vector<double> times = {0.5, 1, 1.5, 2};
  EXPECT_EQ(yield_band(steps, times, 3, 200).low, yield_band(steps, times, 3, 200).low);
  EXPECT_NE(yield_band(steps, times, 3, 200).low, yield_band(steps, times, 4, 200).low);
}

TEST(YieldBand, OfOneRunOrNone) {
  const CurveBand one = yield_band({{1}}, {0, 2}, 1);
  EXPECT_EQ(one.mean, (std::vector<double>{0, 1}));
  EXPECT_EQ(one.low[1], -kInf);
  EXPECT_EQ(one.high[1], kInf);
  EXPECT_TRUE(std::isnan(yield_band({}, {1}, 1).mean[0]));
  EXPECT_TRUE(yield_band({{1}, {2}}, {}, 1).mean.empty());
  const CurveBand equal = yield_band({{1}, {1}, {1}}, {2}, 1);
  EXPECT_EQ(equal.low[0], 1);
  EXPECT_EQ(equal.high[0], 1);
}

// Largest k with P(Binomial(n, p) <= k - 1) < q: the quantile q.
int binomial_quantile(int n, double p, double q) {
  double sum = 0;
  for (int k = 0; k <= n; ++k) {
    sum += p <= 0 ? (k == 0) : p >= 1 ? (k == n) : binomial(n, k, p);
    if (sum >= q - 1e-12) return k;
  }
  return n;
}

TEST(Quantiles, HalfWidthsAreThoseOfTables) {
  EXPECT_NEAR(normal_half_width(), 1.959964, 1e-6);
  EXPECT_NEAR(normal_quantile(0.95), 1.644854, 1e-6);
  EXPECT_NEAR(student_half_width(1), 12.7062, 1e-4);
  EXPECT_NEAR(student_half_width(3), 3.18245, 1e-5);
  EXPECT_NEAR(student_half_width(30), 2.04227, 1e-5);
}

TEST(ChiSquaredZ, HasTheProbabilityOfTheSquare) {
  for (const double z : {0.5, 2.0, 30.0}) EXPECT_DOUBLE_EQ(chi_squared_z(z * z, 1), z);
  // Two degrees of freedom: exp(-square / 2), so a twentieth at 5.991 and a thousandth at 13.816.
  EXPECT_NEAR(chi_squared_z(5.9915, 2), 1.6449, 0.02);
  EXPECT_NEAR(chi_squared_z(13.8155, 2), 3.0902, 0.05);
  // Tables: 95 % and 99.9 % of five and twenty degrees.
  EXPECT_NEAR(chi_squared_z(11.0705, 5), 1.6449, 0.01);
  EXPECT_NEAR(chi_squared_z(45.3147, 20), 3.0902, 0.02);
}

TEST(YieldBand, IsTheBinomialQuantileForOneStepARun) {
  // With x of n runs stepped, a resample's mean is Binomial(n, x / n) / n: the whole bootstrap has
  // closed form. 2000 resamples know the share below a quantile to 4 deviations, 0.014.
  constexpr int n = 30;
  std::vector<Estimate> ends;
  for (int x = 0; x <= n; ++x) {
    std::vector<std::vector<double>> steps(n);
    for (int r = 0; r < x; ++r) steps[r].push_back(0.5);
    const CurveBand band = yield_band(steps, {1}, 77);
    const double p = static_cast<double>(x) / n;
    EXPECT_GE(band.low[0] * n, binomial_quantile(n, p, 0.011) - 1e-9) << x;
    EXPECT_LE(band.low[0] * n, binomial_quantile(n, p, 0.039) + 1e-9) << x;
    EXPECT_GE(band.high[0] * n, binomial_quantile(n, p, 0.961) - 1e-9) << x;
    EXPECT_LE(band.high[0] * n, binomial_quantile(n, p, 0.989) + 1e-9) << x;
    ends.push_back({band.mean[0], band.low[0], band.high[0]});
  }
  // Exact coverage: percentile intervals of 30 fall short of 95 % by a few per cent, no more.
  double sum = 0;
  int count = 0;
  for (double p = 0.2; p < 0.805; p += 0.005, ++count) {
    for (int x = 0; x <= n; ++x) {
      if (ends[x].low <= p && p <= ends[x].high) sum += binomial(n, x, p);
    }
  }
  EXPECT_GT(sum / count, 0.92);
  EXPECT_LT(sum / count, 0.96);
}

}  // namespace
}  // namespace lilytank
