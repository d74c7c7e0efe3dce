// What is told of a study, against tables worked by hand and processes of known law.
#include "lilytank/study_summary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lilytank/error.hpp"
#include "statistics/text_table.hpp"
#include "support/study_tables.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

using sample::exponential_study;
using sample::run_row;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(csv);
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> row(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted)
        row.emplace_back();
      else
        row.back() += c;
    }
    rows.push_back(row);
  }
  return rows;
}

// Two settings of three runs each, 100 s long, three copies possible.
StudyTable by_hand() {
  StudyTable table;
  table.name = "hand";
  table.axes = {"flow.pump_power"};
  table.labels = {"slow", "fast, \"new\""};
  table.horizon = 100;
  table.rows = {run_row(0, 0, {50}),         run_row(0, 1, {20, 60}), run_row(0, 2, {}),
                run_row(1, 0, {10, 20, 40}), run_row(1, 1, {30, 90}), run_row(1, 2, {50})};
  return table;
}

TEST(StudySummary, OfATableByHand) {
  const StudySummary s = summarise(by_hand());
  ASSERT_EQ(s.settings.size(), 2u);
  EXPECT_EQ(s.copies, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(s.horizon, 100);
  EXPECT_EQ(s.restricted_to, 100);
  const SettingSummary &slow = s.settings[0], &fast = s.settings[1];
  EXPECT_EQ(slow.label, "slow");
  EXPECT_EQ(slow.runs, 3);
  EXPECT_DOUBLE_EQ(slow.copies.value, 1);
  EXPECT_DOUBLE_EQ(fast.copies.value, 2);
  EXPECT_EQ(slow.full_yield.value, 0);
  EXPECT_DOUBLE_EQ(fast.full_yield.value, 1.0 / 3);
  EXPECT_DOUBLE_EQ(fast.full_yield.high, wilson(1, 3).high);
  EXPECT_DOUBLE_EQ(slow.rate.value, 3.0 / 300);
  EXPECT_DOUBLE_EQ(fast.rate.value, 6.0 / 240) << "the first run is full after 40 s";
  EXPECT_DOUBLE_EQ(fast.rate.low, poisson_rate(6, 240).low);
  ASSERT_EQ(slow.times.size(), 3u);
  EXPECT_DOUBLE_EQ(slow.times[0].restricted_mean.value, (50 + 20 + 100) / 3.0);
  EXPECT_DOUBLE_EQ(slow.times[1].restricted_mean.value, (100 + 60 + 100) / 3.0);
  EXPECT_DOUBLE_EQ(slow.times[2].restricted_mean.value, 100);
  EXPECT_DOUBLE_EQ(slow.times[0].reached.value, 2.0 / 3);
  EXPECT_EQ(slow.times[0].survival.time, (std::vector<double>{20, 50, 100}));
  EXPECT_EQ(slow.times[0].survival.censored.back(), 1);
  ASSERT_EQ(fast.yield.time.size(), 241u);
  EXPECT_DOUBLE_EQ(fast.yield.mean.back(), 2);
  EXPECT_DOUBLE_EQ(fast.yield.mean[24], 1.0 / 3) << "at 10 s, the first copy";
}

TEST(StudySummary, ComparesRunsThatShareASeed) {
  const StudySummary s = summarise(by_hand());
  ASSERT_EQ(s.pair_tests.size(), 4u);
  EXPECT_EQ(s.pair_tests[0].k, 0);
  EXPECT_EQ(s.pair_tests[0].a, 1);
  EXPECT_EQ(s.pair_tests[0].b, 0);
  EXPECT_EQ(s.pair_tests[0].pairs, 3);
  EXPECT_DOUBLE_EQ(s.pair_tests[0].result.difference.value, 1);
  EXPECT_DOUBLE_EQ(s.pair_tests[1].result.difference.value, (-40 + 10 - 50) / 3.0);
  ASSERT_EQ(s.survival_tests.size(), 3u) << "two settings: the test of all is that of the pair";
  EXPECT_EQ(s.survival_tests[0].a, 1);
  const TestResult same =
      log_rank({{{10, true}, {30, true}, {50, true}}, {{50, true}, {20, true}, {100, false}}});
  EXPECT_DOUBLE_EQ(s.survival_tests[0].result.statistic, same.statistic);

  StudyTable table = by_hand();
  table.rows[0].seed = 5;                      // not the seed of its partner
  table.rows[1].status = RunStatus::diverged;  // its partner stays alone
  const StudySummary less = summarise(table);
  ASSERT_FALSE(less.pair_tests.empty());
  EXPECT_EQ(less.pair_tests[0].pairs, 1);
  EXPECT_TRUE(std::isnan(less.pair_tests[0].result.p));
  EXPECT_TRUE(std::isnan(less.pair_tests[0].adjusted_p));
  EXPECT_TRUE(has(study_text(less), "One pair is no test: the test needs two pairs or more."));
  EXPECT_FALSE(has(study_text(s), "One pair is no test"));
  EXPECT_TRUE(has(comparisons_csv(less), ",,,,,,,\n")) << "a difference, nothing else";
}

TEST(StudySummary, CountsDivergedRunsAndLeavesThemOut) {
  StudyTable table = by_hand();
  const StudySummary before = summarise(table);
  RunRow bad = run_row(1, 3, {1, 2, 3}, 3);
  bad.status = RunStatus::diverged;
  bad.illegal = 3;
  table.rows.push_back(bad);
  const StudySummary after = summarise(table);
  EXPECT_EQ(after.settings[1].runs, 3);
  EXPECT_EQ(after.settings[1].diverged, 1);
  EXPECT_EQ(after.settings[1].illegal, 3) << "an illegal assembly counts wherever it appears";
  EXPECT_EQ(after.settings[1].copies.value, before.settings[1].copies.value);
  EXPECT_EQ(after.settings[1].rate.high, before.settings[1].rate.high);
  EXPECT_EQ(survival_csv(after), survival_csv(before));
  EXPECT_EQ(comparisons_csv(after), comparisons_csv(before));
  const std::string text = study_text(after);
  EXPECT_TRUE(has(text, "2 settings, 7 runs to 100 s")) << text;
  EXPECT_TRUE(has(text, "diverged            1, excluded below")) << text;
  EXPECT_TRUE(has(text, "illegal assemblies  3")) << text;
}

TEST(StudySummary, DoesNotDependOnTheOrderOfRows) {
  StudyTable table = exponential_study({0.01, 0.02, 0.04}, 12, 100);
  const StudySummary a = summarise(table);
  std::reverse(table.rows.begin(), table.rows.end());
  const StudySummary b = summarise(table);
  EXPECT_EQ(study_text(a), study_text(b));
  EXPECT_EQ(summary_csv(a), summary_csv(b));
  EXPECT_EQ(yield_curve_csv(a), yield_curve_csv(b));
  EXPECT_EQ(survival_csv(a), survival_csv(b));
  EXPECT_EQ(comparisons_csv(a), comparisons_csv(b));
}

TEST(StudySummary, FindsKnownRatesAndTimes) {
  // Copies at rate 0.02 /s, 2000 runs of 100 s: P(no copy by 100 s) = exp(-2).
  constexpr double rate = 0.02, horizon = 100;
  constexpr int runs = 2000;
  const StudySummary s = summarise(exponential_study({rate}, runs, horizon));
  const SettingSummary& setting = s.settings[0];
  const double x = rate * horizon, stay = std::exp(-x);
  const double full = 1 - stay * (1 + x + x * x / 2);  // three Poisson events or more
  EXPECT_NEAR(setting.full_yield.value, full, 4 * std::sqrt(full * (1 - full) / runs));
  // Copies are min(N, 3) with N of Poisson(x).
  const double p1 = x * stay, p2 = x * x / 2 * stay;
  const double mean = p1 + 2 * p2 + 3 * full, square = p1 + 4 * p2 + 9 * full;
  EXPECT_NEAR(setting.copies.value, mean, 4 * std::sqrt((square - mean * mean) / runs));
  // The rate is copies over time watched; its relative deviation is one over the root of copies.
  EXPECT_NEAR(setting.rate.value / rate, 1, 4 / std::sqrt(mean * runs));
  // E min(T, h) of the first copy: (1 - exp(-x)) / rate; its variance is below 1 / rate^2.
  EXPECT_NEAR(setting.times[0].restricted_mean.value, (1 - stay) / rate,
              4 / rate / std::sqrt(runs));
  // The second: the sum of two, cut; the integral of exp(-r t)(1 + r t).
  EXPECT_NEAR(setting.times[1].restricted_mean.value, (2 * (1 - stay) - x * stay) / rate,
              4 * std::sqrt(2.0) / rate / std::sqrt(runs));
  const CurveBand& band = setting.yield;
  EXPECT_DOUBLE_EQ(band.mean.back(), setting.copies.value);
  EXPECT_NEAR((band.high.back() - band.low.back()) / (setting.copies.high - setting.copies.low), 1,
              0.1)
      << "the bootstrap's and Student's interval of the same mean";
}

TEST(StudySummary, ComparesAllPairsOfFewAndOneWithEachOfMany) {
  const StudySummary few = summarise(exponential_study({0.01, 0.02, 0.03, 0.04}, 6, 100));
  EXPECT_TRUE(few.all_pairs);
  EXPECT_EQ(few.pair_tests.size(), 4u * 6) << "copies and three times, six pairs";
  EXPECT_EQ(few.survival_tests.size(), 3u * 7) << "three times, all and six pairs";
  EXPECT_EQ(few.survival_tests[0].a, -1);
  EXPECT_EQ(few.survival_tests[0].result.degrees, 3);
  const StudySummary many = summarise(exponential_study(std::vector<double>(9, 0.02), 6, 100));
  EXPECT_FALSE(many.all_pairs);
  EXPECT_EQ(many.pair_tests.size(), 4u * 8);
  for (const PairTest& t : many.pair_tests) EXPECT_EQ(t.b, 0);
  EXPECT_TRUE(has(study_text(many), "each setting against setting 0"));
}

TEST(StudySummary, AdjustsForManyPairsAfterHolm) {
  const StudySummary s = summarise(exponential_study({0.01, 0.012, 0.05}, 20, 100));
  std::vector<double> p, adjusted;
  for (const PairTest& t : s.pair_tests) {
    if (t.k == 1) p.push_back(t.result.p), adjusted.push_back(t.adjusted_p);
  }
  ASSERT_EQ(p.size(), 3u);
  std::sort(p.begin(), p.end()), std::sort(adjusted.begin(), adjusted.end());
  const double first = std::min(1.0, 3 * p[0]), second = std::max(first, std::min(1.0, 2 * p[1]));
  EXPECT_DOUBLE_EQ(adjusted[0], first);
  EXPECT_DOUBLE_EQ(adjusted[1], second);
  EXPECT_DOUBLE_EQ(adjusted[2], std::max(second, p[2]));
}

TEST(StudySummary, TellsOfRoundNumbersOfManyCopies) {
  EXPECT_EQ(summarise(exponential_study({1}, 2, 100, 8)).copies.size(), 8u);
  EXPECT_EQ(summarise(exponential_study({1}, 2, 100, 9)).copies, (std::vector<int>{1, 2, 5, 9}));
  EXPECT_EQ(summarise(exponential_study({1}, 2, 100, 100)).copies,
            (std::vector<int>{1, 2, 5, 10, 20, 50, 100}));
}

TEST(StudySummary, RestrictsToWhatEverySettingSaw) {
  StudyTable table;
  table.horizon = 100;
  table.rows = {run_row(0, 0, {10}, 100), run_row(0, 1, {70}, 100), run_row(1, 0, {20}, 60),
                run_row(1, 1, {}, 60)};
  const StudySummary s = summarise(table);
  EXPECT_EQ(s.restricted_to, 60);
  EXPECT_DOUBLE_EQ(s.settings[0].times[0].restricted_mean.value, 35);
  EXPECT_DOUBLE_EQ(s.settings[1].times[0].restricted_mean.value, 40);
  EXPECT_DOUBLE_EQ(s.settings[1].yield.time.back(), 60);
  // A run that ended with full yield was watched to the end: nothing more could come.
  table.rows = {run_row(0, 0, {10, 20, 30}, 30), run_row(0, 1, {5, 8, 25}, 25)};
  EXPECT_EQ(summarise(table).restricted_to, 100);
  EXPECT_DOUBLE_EQ(summarise(table).settings[0].times[2].restricted_mean.value, 27.5);
}

TEST(StudySummary, OfLittle) {
  EXPECT_TRUE(has(study_text(summarise({})), "0 settings, 0 runs"));
  StudyTable one;
  one.name = "one";
  one.labels = {"a", "b"};
  one.rows = {run_row(0, 0, {10})};
  const StudySummary s = summarise(one);
  EXPECT_EQ(s.horizon, 100) << "from the rows where the table does not say";
  ASSERT_EQ(s.settings.size(), 2u);
  EXPECT_EQ(s.settings[1].runs, 0);
  EXPECT_TRUE(s.settings[1].times.empty());
  EXPECT_TRUE(s.survival_tests.empty());
  EXPECT_TRUE(s.pair_tests.empty());
  EXPECT_FALSE(has(study_text(s), "nan"));
  for (const auto& csv : {summary_csv(s), yield_curve_csv(s), survival_csv(s)}) {
    EXPECT_FALSE(has(csv, "nan")) << csv;
    EXPECT_FALSE(has(csv, "inf")) << csv;
  }
  // Without a target there are no copies to tell of.
  one.rows[0].possible = 0;
  EXPECT_TRUE(summarise(one).copies.empty());
  EXPECT_FALSE(has(study_text(summarise(one)), "k-th copy"));
  // Nothing was built at all.
  one.rows = {run_row(0, 0, {}), run_row(0, 1, {}), run_row(1, 0, {}), run_row(1, 1, {})};
  const StudySummary nothing = summarise(one);
  EXPECT_EQ(nothing.settings[0].times[0].restricted_mean.value, 100);
  EXPECT_EQ(nothing.survival_tests[0].result.p, 1);
  EXPECT_EQ(nothing.pair_tests[0].result.p, 1);
}

TEST(StudySummary, IntervalsOfCopiesEndAtWhatIsPossible) {
  StudyTable table;
  table.labels = {"few", "most"}, table.horizon = 100;
  table.rows = {run_row(0, 0, {}), run_row(0, 1, {10, 20}), run_row(1, 0, {10, 20, 30}),
                run_row(1, 1, {10})};
  const StudySummary s = summarise(table);
  EXPECT_EQ(s.settings[0].copies.low, 0);
  EXPECT_EQ(s.settings[1].copies.high, 3);
  EXPECT_LT(s.settings[1].copies.value, 3);
}

TEST(StudySummary, SaysNothingOfTimesThatNoRunCameTo) {
  StudyTable table;
  table.labels = {"a", "b"}, table.horizon = 100;
  table.rows = {run_row(0, 0, {10}), run_row(0, 1, {20}), run_row(1, 0, {}), run_row(1, 1, {30})};
  const StudySummary s = summarise(table);
  ASSERT_EQ(s.pair_tests.size(), 4u);
  EXPECT_TRUE(s.pair_tests[0].reached && s.pair_tests[1].reached);
  EXPECT_FALSE(s.pair_tests[2].reached);
  const std::string text = study_text(s), csv = comparisons_csv(s);
  EXPECT_TRUE(has(text, "  time to copy 3 (s)  1 - 0         2  -  ")) << text;
  EXPECT_TRUE(has(text, "     3  1, 0                -        -     -         -\n")) << text;
  EXPECT_TRUE(has(csv, "\npaired_time,3,1,0,b,a,2,s,,,,,,,,\n")) << csv;
  EXPECT_TRUE(has(csv, "\nlog_rank,3,1,0,b,a,,,,,,,,,,\n")) << csv;
  const auto rows = cells_of(csv);
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size()) << csv;
}

TEST(StudyCsv, IsTidyAndComplete) {
  StudyTable table = by_hand();
  const StudySummary s = summarise(table);
  for (const auto& csv :
       {summary_csv(s), yield_curve_csv(s), survival_csv(s), comparisons_csv(s)}) {
    const auto rows = cells_of(csv);
    ASSERT_GT(rows.size(), 1u);
    for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size()) << csv;
  }
  EXPECT_EQ(cells_of(summary_csv(s))[0],
            (std::vector<std::string>{"setting", "label", "flow.pump_power", "metric", "k", "unit",
                                      "value", "low", "high", "runs"}));
  EXPECT_TRUE(has(summary_csv(s), "1,\"fast, \"\"new\"\"\",1,copies,,1,2,"));
  EXPECT_TRUE(has(summary_csv(s), "0,slow,0,assembly_rate,,1/h,36,"));
  EXPECT_TRUE(has(summary_csv(s), "0,slow,0,restricted_mean_time,3,s,100,"));
  EXPECT_TRUE(has(survival_csv(s), "0,slow,0,1,0,1,1,1,3,0,0\n0,slow,0,1,20,0.6666666667,"));
  EXPECT_TRUE(has(comparisons_csv(s), "paired_copies,,1,0,"));
}

TEST(StudyFiles, AreWrittenWhole) {
  const TemporaryDirectory dir;
  const StudySummary s = summarise(by_hand());
  write_study_summary(s, study_report(s), dir.path("a/b"));
  EXPECT_EQ(dir.read("a/b/summary.txt"), study_text(s));
  EXPECT_EQ(dir.read("a/b/summary.csv"), summary_csv(s));
  EXPECT_EQ(dir.read("a/b/yield_curve.csv"), yield_curve_csv(s));
  EXPECT_EQ(dir.read("a/b/survival.csv"), survival_csv(s));
  EXPECT_EQ(dir.read("a/b/comparisons.csv"), comparisons_csv(s));
  dir.write("file", "");
  EXPECT_THROW(write_study_summary(s, study_report(s), dir.path("file/x")), InputError);
}

TEST(TextTable, AlignsNumbersRightAndTextLeft) {
  TextTable table({"name", "n"});
  table.add({"µ", "5"});
  table.add({"long one", "-12"});
  EXPECT_EQ(table.text(), "  name        n\n  µ           5\n  long one  -12\n");
}

TEST(TextTable, NumbersHaveTheDigitsThatTheyDeserve) {
  EXPECT_EQ(with_interval({2.1347, 1.8012, 2.4721}), "2.13 [1.80, 2.47]");
  EXPECT_EQ(with_interval({7200, 3600, 10800}, 3600), "2.0 [1.0, 3.0]");
  EXPECT_EQ(with_interval({5, -INFINITY, INFINITY}), "5.00");
  EXPECT_EQ(with_interval({NAN, 0, INFINITY}), "- [0.00, inf]");
  EXPECT_EQ(with_interval({0.93333, 0.7867, 0.9815}, 1, 2), "0.93 [0.79, 0.98]");
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
  EXPECT_EQ(p_text(0.03149), "0.031");
  EXPECT_EQ(p_text(4.2e-5), "4.2e-05");
}

}  // namespace
}  // namespace lilytank
