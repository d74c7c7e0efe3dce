// Optimal computing budget allocation: which of several noisy candidates to look at again.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "lilytank/search.hpp"

namespace lilytank {
namespace {

/// Smallest difference of means that counts, in deviations: bounds the share of a candidate whose
/// mean happens to equal the best one's.
constexpr double kLeastDifference = 1e-3;

bool competes(const OcbaCandidate& candidate) {
  return std::isfinite(candidate.mean);
}

/// The lowest mean; the first of equals. -1 where no candidate competes.
int best_of(std::span<const OcbaCandidate> candidates) {
  int best = -1;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!competes(candidates[i])) continue;
    if (best < 0 || candidates[i].mean < candidates[static_cast<std::size_t>(best)].mean) {
      best = static_cast<int>(i);
    }
  }
  return best;
}

/// Chen's N_i up to a common factor; 0 for who does not compete.
std::vector<double> ratios(std::span<const OcbaCandidate> candidates) {
  std::vector<double> out(candidates.size(), 0.0);
  const int best = best_of(candidates);
  if (best < 0) return out;
  const OcbaCandidate& leader = candidates[static_cast<std::size_t>(best)];
  double squares = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const OcbaCandidate& c = candidates[i];
    if (static_cast<int>(i) == best || !competes(c) || !(c.deviation > 0)) continue;
    const double difference = std::max(c.mean - leader.mean, kLeastDifference * c.deviation);
    const double ratio = c.deviation / difference;
    out[i] = ratio * ratio;
    squares += out[i] * out[i] / (c.deviation * c.deviation);
  }
  out[static_cast<std::size_t>(best)] = leader.deviation * std::sqrt(squares);
  return out;
}

/// Parts of `total` in these ratios; equal parts among `active` where all ratios are 0.
std::vector<double> parts(const std::vector<double>& ratio, const std::vector<char>& active,
                          double total) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    if (active[i]) sum += ratio[i], ++count;
  }
  std::vector<double> out(ratio.size(), 0.0);
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    if (active[i]) out[i] = total * (sum > 0 ? ratio[i] / sum : 1.0 / count);
  }
  return out;
}

std::vector<char> competitors(std::span<const OcbaCandidate> candidates) {
  std::vector<char> active;
  for (const OcbaCandidate& c : candidates) active.push_back(competes(c) ? 1 : 0);
  // No difference is known: equal shares.
  if (best_of(candidates) < 0) std::fill(active.begin(), active.end(), char{1});
  return active;
}

/// Whole numbers near `real`, which sum to `total`: rounded down, what is left by falling
/// remainder.
std::vector<int> rounded(const std::vector<double>& real, int total) {
  std::vector<int> out(real.size());
  std::vector<std::size_t> order(real.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = 0; i < real.size(); ++i) {
    out[i] = std::min(static_cast<int>(real[i]), total), total -= out[i];
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return real[a] - std::floor(real[a]) > real[b] - std::floor(real[b]);
  });
  for (std::size_t k = 0; total > 0; ++k, --total) ++out[order[k % order.size()]];
  return out;
}

}  // namespace

std::vector<double> ocba_targets(std::span<const OcbaCandidate> candidates, int extra) {
  double total = extra;
  for (const OcbaCandidate& c : candidates) total += c.evaluations;
  return parts(ratios(candidates), competitors(candidates), total);
}

std::vector<int> ocba_shares(std::span<const OcbaCandidate> candidates, int extra) {
  if (candidates.empty()) return {};
  const std::vector<double> ratio = ratios(candidates);
  std::vector<char> active = competitors(candidates);
  // Whoever has had more than its target keeps it; the rest then share what remains.
  for (;;) {
    double total = extra;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (active[i]) total += candidates[i].evaluations;
    }
    std::vector<double> more = parts(ratio, active, total);
    bool over = false;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (!active[i]) continue;
      more[i] -= candidates[i].evaluations;
      if (more[i] < 0) active[i] = 0, over = true;
    }
    if (!over) return rounded(more, extra);
  }
}

}  // namespace lilytank
