#include <algorithm>
#include <cmath>

#include "lilytank/metrics.hpp"
#include "statistics/undefined.hpp"

namespace lilytank {
namespace {

struct LagRange {
  std::size_t from = 0, to = 0;  // bins, `to` included
};

// d log(msd) / d log(lag) over lags from t / 1.25 to 1.25 t.
double exponent_at(const std::vector<double>& lag, const std::vector<double>& msd, std::size_t i) {
  constexpr double kReach = 1.25;
  std::size_t a = i, b = i;
  while (a > 0 && lag[a - 1] >= lag[i] / kReach) --a;
  while (b + 1 < lag.size() && lag[b + 1] <= lag[i] * kReach) ++b;
  if (a == b || !(lag[a] > 0) || !(msd[a] > 0) || !(msd[b] > 0)) return kUndefined;
  return std::log(msd[b] / msd[a]) / std::log(lag[b] / lag[a]);
}

bool find_range(const std::vector<double>& lag, const std::vector<double>& msd, LagRange& best) {
  constexpr double kTolerance = 0.15;
  double widest = 2;  // at least
  bool found = false;
  for (std::size_t i = 0; i < lag.size();) {
    std::size_t j = i;
    while (j < lag.size() && std::fabs(exponent_at(lag, msd, j) - 1) <= kTolerance) ++j;
    if (j > i + 1 && lag[j - 1] / lag[i] >= widest) {
      widest = lag[j - 1] / lag[i], best = {i, j - 1}, found = true;
    }
    i = std::max(j, i + 1);
  }
  return found;
}

// Slope of the straight line that fits best. Longer lags are noisier, in proportion to themselves:
// each counts by 1 / lag^2, and lags that lie close together share.
double slope(const std::vector<double>& lag, const std::vector<double>& msd,
             const LagRange& range) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = range.from; i <= range.to; ++i) {
    if (std::isnan(msd[i])) continue;
    const double w = 1 / (lag[i] * lag[i]);
    n += w, sx += w * lag[i], sy += w * msd[i];
    sxx += w * lag[i] * lag[i], sxy += w * lag[i] * msd[i];
  }
  const double spread = n * sxx - sx * sx;
  return spread > 0 ? (n * sxy - sx * sy) / spread : kUndefined;
}

}  // namespace

Diffusion diffusion(const BodySums& sums, const std::vector<double>& lags, int dimensions,
                    double from, double to, const Bootstrap& bootstrap) {
  Diffusion result{{kUndefined, kUndefined, kUndefined}, 0, 0};
  LagRange range;
  if (to > 0) {
    const auto low = std::lower_bound(lags.begin(), lags.end(), std::max(from, 1e-12));
    const auto high = std::upper_bound(lags.begin(), lags.end(), to);
    if (high - low < 2) return result;
    range = {static_cast<std::size_t>(low - lags.begin()),
             static_cast<std::size_t>(high - lags.begin()) - 1};
  } else {
    const std::vector<double> msd = ratio_values(sums);
    if (!find_range(lags, msd, range)) return result;
  }
  result.from = lags[range.from], result.to = lags[range.to];
  result.D = ratio_functional(
      sums,
      [&](const std::vector<double>& msd) { return slope(lags, msd, range) / (2 * dimensions); },
      bootstrap);
  return result;
}

}  // namespace lilytank
