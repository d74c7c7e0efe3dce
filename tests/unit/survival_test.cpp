// Survival curves and what is made of them, against published examples and exponential times.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lilytank/statistics.hpp"
#include "support/samples.hpp"

namespace lilytank {
namespace {

using namespace lilytank::test;

// Exponential times of rate 1, censored by exponential times of rate `censoring`.
std::vector<Duration> exponentials(std::uint64_t set, int n, double censoring,
                                   std::uint32_t what = 0) {
  std::vector<Duration> durations;
  for (int i = 0; i < n; ++i) {
    const double t = exponential_at(set, i, 2 * what);
    const double c = censoring > 0 ? exponential_at(set, i, 2 * what + 1) / censoring : kInf;
    durations.push_back({std::min(t, c), t <= c});
  }
  return durations;
}

// Remission of leukaemia (weeks), Freireich et al., Blood 21 (1963) 699.
std::vector<Duration> treated() {
  std::vector<Duration> d;
  for (const double t : {6, 6, 6, 7, 10, 13, 16, 22, 23}) d.push_back({t, true});
  for (const double t : {6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35}) d.push_back({t, false});
  return d;
}
std::vector<Duration> placebo() {
  std::vector<Duration> d;
  for (const double t : {1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23}) {
    d.push_back({t, true});
  }
  return d;
}

TEST(KaplanMeier, MatchesAWorkedExample) {
  // Kleinbaum and Klein, Survival Analysis, ch. 2: the treated group.
  const Survival s = kaplan_meier(treated());
  struct Row {
    double time, survival, error;
    int at_risk, events;
  };
  for (const Row& row :
       {Row{6, 0.857, 0.0764, 21, 3}, Row{7, 0.807, 0.0869, 17, 1}, Row{10, 0.753, 0.0963, 15, 1},
        Row{13, 0.690, 0.1068, 12, 1}, Row{16, 0.627, 0.1141, 11, 1}, Row{22, 0.538, 0.1282, 7, 1},
        Row{23, 0.448, 0.1346, 6, 1}}) {
    const auto at = std::find(s.time.begin(), s.time.end(), row.time) - s.time.begin();
    ASSERT_LT(at, static_cast<std::ptrdiff_t>(s.time.size()));
    EXPECT_NEAR(s.survival[at], row.survival, 6e-4) << row.time;
    EXPECT_NEAR(std::sqrt(s.variance[at]), row.error, 6e-5) << row.time;
    EXPECT_EQ(s.at_risk[at], row.at_risk);
    EXPECT_EQ(s.events[at], row.events);
  }
  EXPECT_EQ(s.censored[0], 1) << "the one censored at 6, after the events there";
  EXPECT_EQ(s.time.size(), 16u);
}

TEST(KaplanMeier, LogLogIntervalByHand) {
  // 1, 2, 2+, 3, 4+, 5: survival 5/6, 2/3, 4/9, 4/9, 0.
  const Survival s =
      kaplan_meier({{5, true}, {2, false}, {1, true}, {4, false}, {2, true}, {3, true}});
  ASSERT_EQ(s.time, (std::vector<double>{1, 2, 3, 4, 5}));
  const std::vector<double> survival = {5.0 / 6, 2.0 / 3, 4.0 / 9, 4.0 / 9, 0};
  const std::vector<double> sums = {1 / 30., 1 / 30. + 1 / 20., 1 / 30. + 1 / 20. + 1 / 6.};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(s.survival[i], survival[i], 1e-15);
    EXPECT_NEAR(s.variance[i], survival[i] * survival[i] * sums[i], 1e-15);
    const double reach = std::exp(kZ * std::sqrt(sums[i]) / -std::log(survival[i]));
    EXPECT_NEAR(s.low[i], std::pow(survival[i], reach), 1e-12);
    EXPECT_NEAR(s.high[i], std::pow(survival[i], 1 / reach), 1e-12);
  }
  EXPECT_EQ(s.survival[3], s.survival[2]);
  EXPECT_EQ(s.low[3], s.low[2]);
  EXPECT_EQ(s.survival[4], 0);
  EXPECT_EQ(s.low[4], 0);
  EXPECT_EQ(s.high[4], s.high[3]);
  EXPECT_EQ(s.variance[4], 0);
}

TEST(KaplanMeier, WithoutEventsStaysAtOneWithinAnExactInterval) {
  const Survival s = kaplan_meier({{4, false}, {4, false}, {4, false}});
  ASSERT_EQ(s.time.size(), 1u);
  EXPECT_EQ(s.survival[0], 1);
  EXPECT_EQ(s.events[0], 0);
  EXPECT_EQ(s.censored[0], 3);
  EXPECT_NEAR(std::pow(s.low[0], 3), 0.025, 1e-12) << "three of three with probability 0.025";
  EXPECT_EQ(s.high[0], 1);
  EXPECT_TRUE(kaplan_meier({}).time.empty());
}

TEST(KaplanMeier, OfOneFallsToZeroAndClaimsNothing) {
  const Survival s = kaplan_meier({{7, true}});
  EXPECT_EQ(s.survival[0], 0);
  EXPECT_EQ(s.low[0], 0);
  EXPECT_EQ(s.high[0], 1);
}

// The last entry at or before a time.
std::size_t entry_at(const Survival& s, double time) {
  return static_cast<std::size_t>(std::upper_bound(s.time.begin(), s.time.end(), time) -
                                  s.time.begin() - 1);
}

TEST(KaplanMeier, FindsExponentialSurvivalThroughCensoring) {
  constexpr int n = 4000;
  constexpr double censoring = 0.5;
  const Survival s = kaplan_meier(exponentials(1, n, censoring));
  for (const double t : {0.25, 0.5, 1.0, 2.0}) {
    const std::size_t i = entry_at(s, t);
    // Greenwood's limit: S^2 times the integral of hazard / (n * share at risk).
    const double all = 1 + censoring;
    const double variance = std::exp(-2 * t) * (std::exp(all * t) - 1) / (all * n);
    EXPECT_NEAR(s.survival[i], std::exp(-t), 4 * std::sqrt(variance)) << t;
    EXPECT_NEAR(s.variance[i] / variance, 1, 0.15) << t;
  }
}

TEST(KaplanMeier, CoversAsOftenAsItSays) {
  constexpr int sets = 1000;
  const double t = 0.7;
  int covered = 0;
  for (int set = 0; set < sets; ++set) {
    const Survival s = kaplan_meier(exponentials(100 + set, 50, 0.5));
    const std::size_t i = entry_at(s, t);
    covered += s.low[i] <= std::exp(-t) && std::exp(-t) <= s.high[i];
  }
  // Four deviations of a binomial share, and 0.01 for the normal approximation at n = 50.
  EXPECT_NEAR(covered / double{sets}, 0.95, 4 * std::sqrt(0.95 * 0.05 / sets) + 0.01);
}

TEST(RestrictedMean, IsTheMeanOfCutTimesWithoutCensoring) {
  const double horizon = 1.2;
  const std::vector<Duration> durations = exponentials(2, 37, 0);
  double sum = 0, squares = 0;
  for (const Duration& d : durations) {
    const double cut = std::min(d.time, horizon);
    sum += cut, squares += cut * cut;
  }
  const double n = 37, mean = sum / n, deviation = std::sqrt((squares / n - mean * mean) / n);
  const Estimate e = restricted_mean(kaplan_meier(durations), horizon);
  EXPECT_NEAR(e.value, mean, 1e-12);
  EXPECT_NEAR(e.high - e.value, kZ * deviation, 1e-12);
  EXPECT_NEAR(e.value - e.low, kZ * deviation, 1e-12);
  // Censoring at the horizon, as at the end of a run, changes nothing.
  std::vector<Duration> cut = durations;
  for (Duration& d : cut) {
    if (d.time > horizon) d = {horizon, false};
  }
  EXPECT_NEAR(restricted_mean(kaplan_meier(cut), horizon).value, mean, 1e-12);
  EXPECT_NEAR(restricted_mean(kaplan_meier(cut), horizon).low, e.low, 1e-12);
}

TEST(RestrictedMean, FindsTheIntegralForExponentials) {
  constexpr int n = 4000;
  constexpr double horizon = 1.5, censoring = 0.5;
  const Estimate e = restricted_mean(kaplan_meier(exponentials(3, n, censoring)), horizon);
  const double truth = 1 - std::exp(-horizon);
  // The limit of n * variance: the integral of area(t)^2 * hazard / share at risk, by Simpson.
  double integral = 0;
  constexpr int parts = 1000;
  for (int i = 0; i <= parts; ++i) {
    const double t = horizon * i / parts, area = std::exp(-t) - std::exp(-horizon);
    const double weight = i == 0 || i == parts ? 1 : i % 2 == 1 ? 4 : 2;
    integral += weight * area * area * std::exp((1 + censoring) * t) * horizon / parts / 3;
  }
  const double deviation = std::sqrt(integral / n);
  EXPECT_NEAR(e.value, truth, 4 * deviation);
  EXPECT_NEAR((e.high - e.low) / (2 * kZ * deviation), 1, 0.1);
}

TEST(RestrictedMean, OfAWorkedExample) {
  // Survival 1, 5/6, 2/3, 4/9 on unit steps to 3, then 4/9 to 4.5.
  const Survival s =
      kaplan_meier({{5, true}, {2, false}, {1, true}, {4, false}, {2, true}, {3, true}});
  EXPECT_NEAR(restricted_mean(s, 4.5).value, 1 + 5.0 / 6 + 2.0 / 3 + 1.5 * 4 / 9, 1e-12);
  EXPECT_NEAR(restricted_mean(s, 0.5).value, 0.5, 1e-15);
  EXPECT_NEAR(restricted_mean(s, 9).value, 1 + 5.0 / 6 + 2.0 / 3 + 2 * 4.0 / 9, 1e-12);
}

TEST(RestrictedMean, ClaimsNothingThatItDoesNotKnow) {
  const Estimate one = restricted_mean(kaplan_meier({{2, true}}), 10);
  EXPECT_EQ(one.value, 2);
  EXPECT_EQ(one.low, 0);
  EXPECT_EQ(one.high, 10);
  const Estimate none = restricted_mean(kaplan_meier({}), 10);
  EXPECT_TRUE(std::isnan(none.value));
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(none.high, 10);
  const Estimate never = restricted_mean(kaplan_meier({{10, false}, {10, false}}), 10);
  EXPECT_EQ(never.value, 10);
  EXPECT_NEAR(never.low, 10 * std::sqrt(0.025), 1e-12);
  EXPECT_EQ(never.high, 10);
  const Estimate equal = restricted_mean(kaplan_meier({{3, true}, {3, true}, {3, true}}), 10);
  EXPECT_EQ(equal.value, 3);
  EXPECT_EQ(equal.low, 3);
  EXPECT_EQ(equal.high, 3);
}

TEST(LogRank, MatchesTheWorkedExample) {
  // Kleinbaum and Klein, ch. 2: 16.793 with one degree of freedom.
  const TestResult t = log_rank({treated(), placebo()});
  EXPECT_NEAR(t.statistic, 16.793, 6e-4);
  EXPECT_EQ(t.degrees, 1);
  EXPECT_NEAR(t.p, std::erfc(std::sqrt(t.statistic / 2)), 1e-12);
}

TEST(LogRank, OfTwoAndThreeGroupsByHand) {
  // {1, 3} and {2, 4}: observed less expected 2/3, variance 1/4 + 2/9 + 1/4.
  const TestResult two = log_rank({{{1, true}, {3, true}}, {{2, true}, {4, true}}});
  EXPECT_NEAR(two.statistic, (4.0 / 9) / (13.0 / 18), 1e-12);
  // One each at 1, 2, 3: excess (2/3, 1/6), inverse covariance 54/5 (17/36, 1/9; 1/9, 2/9).
  const std::vector<std::vector<Duration>> three = {{{1, true}}, {{2, true}}, {{3, true}}};
  EXPECT_NEAR(log_rank(three).statistic, 2.6, 1e-12);
  EXPECT_EQ(log_rank(three).degrees, 2);
  EXPECT_NEAR(log_rank(three).p, std::exp(-1.3), 1e-12) << "chi-squared of 2 degrees";
  EXPECT_NEAR(log_rank({three[2], three[0], three[1]}).statistic, 2.6, 1e-12);
}

TEST(LogRank, WithNothingToTellSaysSo) {
  const std::vector<Duration> never = {{5, false}, {5, false}};
  for (const TestResult& t : {log_rank({}), log_rank({treated()}), log_rank({never, never}),
                              log_rank({{}, treated()}), log_rank({{{2, true}}, {{2, true}}})}) {
    EXPECT_EQ(t.degrees, 0);
    EXPECT_EQ(t.p, 1);
  }
  const TestResult same = log_rank({treated(), treated()});
  EXPECT_NEAR(same.statistic, 0, 1e-12);
  EXPECT_EQ(same.degrees, 1);
  EXPECT_NEAR(same.p, 1, 1e-6);
  // A group gone before the first event takes no part.
  const TestResult with_gone = log_rank({treated(), {{0.5, false}}, placebo()});
  EXPECT_EQ(with_gone.degrees, 1);
  EXPECT_NEAR(with_gone.statistic, 16.793, 6e-4);
}

TEST(LogRank, HasUniformPWhereGroupsAreAlike) {
  constexpr int sets = 1500;
  for (const int groups : {2, 4}) {
    std::vector<double> p;
    for (int set = 0; set < sets; ++set) {
      std::vector<std::vector<Duration>> samples;
      for (int g = 0; g < groups; ++g) samples.push_back(exponentials(9000 + set, 40, 0.6, g));
      p.push_back(log_rank(samples).p);
    }
    std::sort(p.begin(), p.end());
    double distance = 0;
    for (int i = 0; i < sets; ++i) {
      distance = std::max(
          {distance, std::fabs(p[i] - i / double{sets}), std::fabs(p[i] - (i + 1) / double{sets})});
    }
    // Kolmogorov's 0.1 % bound.
    EXPECT_LT(distance, 1.95 / std::sqrt(sets)) << groups;
  }
}

TEST(LogRank, SeesOneHazardTwiceTheOther) {
  // Schoenfeld: the mean of the signed root is sqrt(events / 4) log 2, here 3.9 with deviation 1.
  const auto fast = exponentials(5, 64, 0);
  auto slow = exponentials(6, 64, 0);
  for (Duration& d : slow) d.time *= 2;
  const double root = std::sqrt(log_rank({fast, slow}).statistic);
  EXPECT_NEAR(root, std::sqrt(128 / 4.0) * std::log(2.0), 4);
  EXPECT_GT(root, kZ);
}

}  // namespace
}  // namespace lilytank
