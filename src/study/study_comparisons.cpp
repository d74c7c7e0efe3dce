#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "study/study_rows.hpp"

namespace lilytank {
namespace {

using Runs = std::vector<std::vector<const RunRow*>>;
using Pair = std::pair<int, int>;

// Beyond, pairs would be more than anybody reads: each setting is then compared with the first.
constexpr std::size_t kAllPairsUpTo = 6;

std::vector<Pair> pairs_of(const Runs& runs, bool all_pairs) {
  std::vector<Pair> pairs;
  const int settings = static_cast<int>(runs.size());
  for (int b = 0; b < (all_pairs ? settings : std::min(1, settings)); ++b) {
    for (int a = b + 1; a < settings; ++a) pairs.emplace_back(a, b);
  }
  return pairs;
}

// Holm, Scand. J. Stat. 6 (1979) 65: the i-th smallest of m (from 0) is multiplied by m - i, and
// none is smaller than the one before. Tests without a p have no part in it.
template <class Test, class P>
void adjust(std::vector<Test>& tests, P p_of) {
  std::vector<std::size_t> order(tests.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) {
    if (!std::isnan(p_of(tests[i]))) return false;
    tests[i].adjusted_p = p_of(tests[i]);
    return true;
  });
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return p_of(tests[i]) < p_of(tests[j]); });
  double least = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto left = static_cast<double>(order.size() - i);
    least = std::max(least, std::min(1.0, left * p_of(tests[order[i]])));
    tests[order[i]].adjusted_p = least;
  }
}

void test_survival(const Runs& runs, const std::vector<Pair>& pairs, int k, StudySummary& summary) {
  std::vector<std::vector<Duration>> groups;
  for (const auto& of_setting : runs) groups.push_back(durations_to(of_setting, k));
  const auto used = std::count_if(groups.begin(), groups.end(),
                                  [](const std::vector<Duration>& g) { return !g.empty(); });
  if (used < 2) return;
  std::vector<SurvivalTest> tests;
  for (const auto& [a, b] : pairs) {
    const auto &x = groups[static_cast<std::size_t>(a)], &y = groups[static_cast<std::size_t>(b)];
    if (!x.empty() && !y.empty()) tests.push_back({k, a, b, log_rank({x, y}), 1});
  }
  adjust(tests, [](const SurvivalTest& t) { return t.result.p; });
  if (used > 2) {
    const TestResult all = log_rank(groups);
    summary.survival_tests.push_back({k, -1, -1, all, all.p});
  }
  summary.survival_tests.insert(summary.survival_tests.end(), tests.begin(), tests.end());
}

// What is compared in a pair of runs; nothing where a run cannot tell.
std::optional<double> compared(const RunRow& row, int k, double restricted_to) {
  if (k == 0) return row.copies;
  if (row.possible < k) return std::nullopt;
  if (reached_copies(row) >= k) {
    return std::min(row.completion[static_cast<std::size_t>(k - 1)], restricted_to);
  }
  if (row.duration < restricted_to) return std::nullopt;
  return restricted_to;
}

PairTest test_pairs(const std::vector<const RunRow*>& a, const std::vector<const RunRow*>& b, int k,
                    double restricted_to) {
  PairTest test;
  test.k = k, test.reached = k == 0;
  std::vector<double> values_a, values_b, differences;
  int possible = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const RunRow &x = *a[i], &y = *b[j];
    if (x.replicate != y.replicate) {
      ++(x.replicate < y.replicate ? i : j);
      continue;
    }
    ++i, ++j;
    const auto value_a = compared(x, k, restricted_to), value_b = compared(y, k, restricted_to);
    if (x.seed != y.seed || !value_a || !value_b) continue;
    values_a.push_back(*value_a), values_b.push_back(*value_b);
    differences.push_back(*value_a - *value_b);
    possible = std::max({possible, x.possible, y.possible});
    test.reached = test.reached || std::min(*value_a, *value_b) < restricted_to;
  }
  test.pairs = static_cast<int>(values_a.size());
  test.result = compare_pairs(values_a, values_b);
  if (k == 0) test.result.difference = bounded_mean_interval(differences, -possible, possible);
  return test;
}

void test_all_pairs(const Runs& runs, const std::vector<Pair>& pairs, int k,
                    StudySummary& summary) {
  std::vector<PairTest> tests;
  for (const auto& [a, b] : pairs) {
    PairTest test = test_pairs(runs[static_cast<std::size_t>(a)], runs[static_cast<std::size_t>(b)],
                               k, summary.restricted_to);
    test.a = a, test.b = b;
    if (test.pairs > 0) tests.push_back(test);
  }
  adjust(tests, [](const PairTest& t) { return t.result.p; });
  summary.pair_tests.insert(summary.pair_tests.end(), tests.begin(), tests.end());
}

}  // namespace

void compare_settings(const Runs& runs, StudySummary& summary) {
  summary.all_pairs = runs.size() <= kAllPairsUpTo;
  const std::vector<Pair> pairs = pairs_of(runs, summary.all_pairs);
  for (const int k : summary.copies) test_survival(runs, pairs, k, summary);
  if (!summary.copies.empty()) test_all_pairs(runs, pairs, 0, summary);
  for (const int k : summary.copies) test_all_pairs(runs, pairs, k, summary);
}

}  // namespace lilytank
