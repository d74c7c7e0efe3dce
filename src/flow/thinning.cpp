#include "flow/thinning.hpp"

#include <cstddef>

namespace lilytank {
namespace {

constexpr double kLongestInterval = 3;  // s
constexpr double kUnrelated = 0.1;      // autocorrelation

// The samples' differences from their cells' means.
void centre(const FlowSamples& s, const std::vector<CellSamples>& cells, std::vector<float>& x,
            std::vector<float>& y) {
  x = s.x, y = s.y;
  for (const CellSamples& cell : cells) {
    double mx = 0, my = 0;
    for (const std::uint32_t i : cell.sample)
      mx += static_cast<double>(s.x[i]), my += static_cast<double>(s.y[i]);
    const double n = static_cast<double>(cell.sample.size());
    for (const std::uint32_t i : cell.sample) {
      x[i] -= static_cast<float>(mx / n);
      y[i] -= static_cast<float>(my / n);
    }
  }
}

double thinning_time(const FlowSamples& s, const std::vector<CellSamples>& cells) {
  std::vector<float> x, y;
  centre(s, cells, x, y);
  const auto longest = static_cast<std::size_t>(kLongestInterval * s.rate);
  const auto product = [&](std::size_t lag) {
    double sum = 0;
    std::int64_t pairs = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) {
      const std::size_t j = i + lag;
      // Frames between may be missing: only pairs that are exactly `lag` apart count.
      if (s.track[i] != s.track[j] || s.frame[j] - s.frame[i] != static_cast<int>(lag)) continue;
      sum += static_cast<double>(x[i] * x[j] + y[i] * y[j]);
      ++pairs;
    }
    return pairs > 0 ? sum / static_cast<double>(pairs) : 0;
  };
  const double variance = product(0);
  for (std::size_t lag = 1; lag < longest; ++lag) {
    if (product(lag) < kUnrelated * variance) return static_cast<double>(lag) / s.rate;
  }
  return kLongestInterval;
}

void find_stays(const FlowSamples& s, double thinning, CellSamples& cell) {
  const double apart = thinning * s.rate;
  for (std::size_t k = 0; k < cell.sample.size(); ++k) {
    const std::uint32_t i = cell.sample[k];
    bool same = false;
    if (k > 0) {
      const std::uint32_t before = cell.sample[k - 1];
      same = s.track[before] == s.track[i] && s.frame[i] - s.frame[before] < apart;
    }
    if (!same) ++cell.stays;
    cell.stay.push_back(cell.stays - 1);
  }
}

}  // namespace

std::vector<CellSamples> by_cell(const FlowSamples& samples, int cells, double& thinning) {
  std::vector<CellSamples> out(static_cast<std::size_t>(cells));
  for (std::size_t i = 0; i < samples.cell.size(); ++i) {
    out[samples.cell[i]].sample.push_back(static_cast<std::uint32_t>(i));
  }
  thinning = thinning_time(samples, out);
  for (CellSamples& cell : out) find_stays(samples, thinning, cell);
  return out;
}

}  // namespace lilytank
