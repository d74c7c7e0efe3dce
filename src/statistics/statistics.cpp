#include "lilytank/statistics.hpp"

#include "statistics/quantiles.hpp"
#include "statistics/undefined.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lilytank {
namespace {

struct SampleMoments {
  double mean = kUndefined;
  double variance = 0;  // unbiased; 0 for fewer than two values
};

SampleMoments moments_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  if (values.empty()) return {};
  double sum = 0;
  for (const double v : values) sum += v;
  SampleMoments m{sum / n, 0};
  // The second sum is zero but for rounding; taking it out keeps equal values at variance 0.
  double squares = 0, rest = 0;
  for (const double v : values) squares += (v - m.mean) * (v - m.mean), rest += v - m.mean;
  if (values.size() > 1) m.variance = std::max(0.0, (squares - rest * rest / n) / (n - 1));
  return m;
}

}  // namespace

Estimate wilson(std::int64_t successes, std::int64_t n, double level) {
  assert(0 <= successes && successes <= n && 0 < level && level < 1);
  if (n == 0) return {kUndefined, 0, 1};
  const double z = normal_half_width(level);
  const auto count = static_cast<double>(n), hits = static_cast<double>(successes);
  const double p = hits / count, k = z * z / count;
  const double centre = (p + k / 2) / (1 + k);
  const double half = z / (1 + k) * std::sqrt(p * (1 - p) / count + k / (4 * count));
  // The ends at no and at all successes are 0 and 1, which rounding would miss.
  return {p, successes == 0 ? 0 : centre - half, successes == n ? 1 : centre + half};
}

Estimate poisson_rate(std::int64_t events, double exposure, double level) {
  assert(events >= 0 && exposure >= 0 && 0 < level && level < 1);
  if (!(exposure > 0)) return {kUndefined, 0, kInfinity};
  const auto count = static_cast<double>(events);
  const double tail = (1 - level) / 2;
  const double low = events == 0 ? 0 : chi_squared_quantile(tail, 2 * count) / 2;
  const double high = chi_squared_upper_quantile(tail, 2 * count + 2) / 2;
  return {count / exposure, low / exposure, high / exposure};
}

Estimate mean_interval(const std::vector<double>& values, double level) {
  assert(0 < level && level < 1);
  const SampleMoments m = moments_of(values);
  if (values.size() < 2) return {m.mean, -kInfinity, kInfinity};
  const auto n = static_cast<double>(values.size());
  const double t = student_half_width(n - 1, level);
  const double half = t * std::sqrt(m.variance / n);
  return {m.mean, m.mean - half, m.mean + half};
}

Estimate bounded_mean_interval(const std::vector<double>& values, double least, double most,
                               double level) {
  Estimate mean = mean_interval(values, level);
  const auto n = static_cast<double>(values.size());
  if (values.size() < 2 || std::ranges::min(values) < std::ranges::max(values)) return mean;
  const double others = 1 - std::pow((1 - level) / 2, 1 / n);
  mean.low = std::min(mean.value, mean.value + others * (least - mean.value));
  mean.high = std::max(mean.value, mean.value + others * (most - mean.value));
  return mean;
}

PairedComparison compare_pairs(const std::vector<double>& a, const std::vector<double>& b,
                               double level) {
  assert(a.size() == b.size());
  std::vector<double> differences(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) differences[i] = a[i] - b[i];
  PairedComparison result;
  result.difference = mean_interval(differences, level);
  if (a.size() < 2) return result;
  const SampleMoments d = moments_of(differences);
  const double apart = moments_of(a).variance + moments_of(b).variance;
  if (d.variance > 0) {
    const auto n = static_cast<double>(a.size());
    const double t = std::fabs(d.mean) / std::sqrt(d.variance / n);
    result.p = std::min(1.0, student_tail(t, n - 1));
    result.saving = apart / d.variance;
  } else {
    // How often chance alone gives all differences one sign.
    result.p = d.mean == 0 ? 1 : std::exp2(1 - static_cast<double>(a.size()));
    result.saving = apart > 0 ? kInfinity : 1;
  }
  return result;
}

}  // namespace lilytank
