#include "search/rank_change.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lilytank {
namespace {

constexpr double kTheta = 0.2;

/// From 1, the lowest value's.
std::vector<int> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<int> rank(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<int>(k) + 1;
  return rank;
}

/// The theta/2 quantile of the rank changes |1 - rank|, |2 - rank|, ... that chance could bring.
double limit(int rank, int count) {
  std::vector<int> changes;
  for (int r = 1; r <= count; ++r) changes.push_back(std::abs(r - rank));
  std::sort(changes.begin(), changes.end());
  const double place = kTheta / 2 * (count - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, changes.size() - 1);
  return changes[below] + (place - static_cast<double>(below)) * (changes[above] - changes[below]);
}

}  // namespace

double rank_change(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> all = first;
  all.insert(all.end(), second.begin(), second.end());
  const std::vector<int> rank = ranks_of(all);
  const int others = static_cast<int>(all.size()) - 1;
  double sum = 0;
  for (std::size_t i = 0; i < second.size(); ++i) {
    const int was = rank[i], is = rank[first.size() + i];
    const int between = std::abs(is - was) - 1;
    // Each value's rank with its own counterpart left out.
    sum += 2 * between - limit(is - (is > was ? 1 : 0), others) -
           limit(was - (was > is ? 1 : 0), others);
  }
  return sum / static_cast<double>(second.size());
}

}  // namespace lilytank
