#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "lilytank/random.hpp"
#include "lilytank/statistics.hpp"
#include "statistics/undefined.hpp"

namespace lilytank {
namespace {

using StepBins = std::vector<std::vector<std::size_t>>;

// [run] the index of the first of `times` by which each of its steps has happened; later ones left
// out. Counting steps by these makes a resample cost one pass over its runs, not one a time.
StepBins bins_of(const std::vector<std::vector<double>>& steps, const std::vector<double>& times) {
  StepBins bins(steps.size());
  for (std::size_t r = 0; r < steps.size(); ++r) {
    for (const double step : steps[r]) {
      const auto at = std::lower_bound(times.begin(), times.end(), step);
      if (at != times.end()) bins[r].push_back(static_cast<std::size_t>(at - times.begin()));
    }
  }
  return bins;
}

// Running total of rises, as a mean over n runs.
void accumulate(const std::vector<std::int64_t>& rises, double n, std::vector<double>& mean) {
  std::int64_t total = 0;
  for (std::size_t t = 0; t < rises.size(); ++t) {
    total += rises[t];
    mean[t] = static_cast<double>(total) / n;
  }
}

// The runs that resample `b` draws, with replacement.
void draw_runs(std::uint64_t seed, int b, std::vector<std::size_t>& drawn) {
  const std::uint64_t n = drawn.size();
  for (std::size_t i = 0; i < drawn.size(); i += 4) {
    const auto bits =
        random_bits({seed, Stream::bootstrap, b, static_cast<std::uint32_t>(i / 4), 0});
    for (std::size_t k = 0; k < 4 && i + k < drawn.size(); ++k) drawn[i + k] = (bits[k] * n) >> 32;
  }
}

// Quantile q of sorted values, linear between them.
double quantile_of(const std::vector<double>& sorted, double q) {
  const double place = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double w = place - static_cast<double>(below);
  return (1 - w) * sorted[below] + w * sorted[above];
}

}  // namespace

CurveBand yield_band(const std::vector<std::vector<double>>& steps,
                     const std::vector<double>& times, std::uint64_t seed, int resamples,
                     double level) {
  assert(std::is_sorted(times.begin(), times.end()) && resamples > 0 && 0 < level && level < 1);
  CurveBand band;
  band.time = times;
  band.mean.assign(times.size(), std::numeric_limits<double>::quiet_NaN());
  band.low.assign(times.size(), -kInfinity);
  band.high.assign(times.size(), kInfinity);
  if (steps.empty()) return band;
  const StepBins bins = bins_of(steps, times);
  const auto n = static_cast<double>(steps.size());
  std::vector<std::int64_t> rises(times.size(), 0);
  for (const auto& run : bins) {
    for (const std::size_t t : run) ++rises[t];
  }
  accumulate(rises, n, band.mean);
  if (steps.size() < 2) return band;
  std::vector<std::vector<double>> means(times.size());  // [time][resample]
  for (auto& m : means) m.reserve(static_cast<std::size_t>(resamples));
  std::vector<std::size_t> drawn(steps.size());
  std::vector<double> mean(times.size());
  for (int b = 0; b < resamples; ++b) {
    draw_runs(seed, b, drawn);
    std::fill(rises.begin(), rises.end(), 0);
    for (const std::size_t r : drawn) {
      for (const std::size_t t : bins[r]) ++rises[t];
    }
    accumulate(rises, n, mean);
    for (std::size_t t = 0; t < times.size(); ++t) means[t].push_back(mean[t]);
  }
  for (std::size_t t = 0; t < times.size(); ++t) {
    std::sort(means[t].begin(), means[t].end());
    band.low[t] = quantile_of(means[t], (1 - level) / 2);
    band.high[t] = quantile_of(means[t], (1 + level) / 2);
  }
  return band;
}

}  // namespace lilytank
