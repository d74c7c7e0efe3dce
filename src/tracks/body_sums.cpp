// Curves and bands from sums over bodies.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "lilytank/metrics.hpp"
#include "lilytank/random.hpp"
#include "statistics/quantiles.hpp"
#include "statistics/undefined.hpp"

namespace lilytank {
namespace {

using Values = std::vector<double>;

// Curves of the bodies and of resamples of them.
class Resampler {
 public:
  // `draw`: another one for each independent source.
  Resampler(const BodySums& sums, const Bootstrap& bootstrap, std::uint32_t draw)
      : sums_(sums),
        bootstrap_(bootstrap),
        draw_(draw),
        times_(static_cast<std::size_t>(sums.bodies())),
        total_(static_cast<std::size_t>(sums.bins)),
        weight_(total_.size()) {}

  Values curve() {
    std::fill(times_.begin(), times_.end(), 1);
    return ratio();
  }
  // The curve of resample `b`: as many bodies, drawn with replacement.
  Values resample(int b) {
    std::fill(times_.begin(), times_.end(), 0);
    const std::uint64_t n = times_.size();
    for (std::size_t i = 0; i < n; i += 4) {
      const auto bits = random_bits(
          {bootstrap_.seed, Stream::bootstrap, b, static_cast<std::uint32_t>(i / 4), draw_});
      for (std::size_t k = 0; k < 4 && i + k < n; ++k) ++times_[(bits[k] * n) >> 32];
    }
    return ratio();
  }

 private:
  Values ratio() {
    std::fill(total_.begin(), total_.end(), 0.0);
    std::fill(weight_.begin(), weight_.end(), 0.0);
    const std::size_t bins = total_.size();
    for (std::size_t b = 0; b < times_.size(); ++b) {
      if (times_[b] == 0) continue;
      const double* sum = &sums_.sum[b * bins];
      const double* weight = &sums_.weight[b * bins];
      for (std::size_t i = 0; i < bins; ++i) {
        total_[i] += times_[b] * sum[i], weight_[i] += times_[b] * weight[i];
      }
    }
    Values out(bins);
    for (std::size_t i = 0; i < bins; ++i)
      out[i] = weight_[i] > 0 ? total_[i] / weight_[i] : kUndefined;
    if (bootstrap_.relative && bins > 0) {
      const double unit = out[0];
      for (double& v : out) v /= unit;
    }
    return out;
  }
  const BodySums& sums_;
  Bootstrap bootstrap_;
  std::uint32_t draw_;
  std::vector<double> times_;  // how often each body was drawn
  Values total_, weight_;
};

// Quantile q of numbers in any order, linear between them; reorders them.
double quantile_of(Values& values, double q) {
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), values.begin() + below, values.end());
  const double low = values[below];
  if (static_cast<std::size_t>(below) + 1 == values.size()) return low;
  const double high = *std::min_element(values.begin() + below + 1, values.end());
  return low + (place - static_cast<double>(below)) * (high - low);
}

// How much wider the interval of n bodies is than their resamples.
double widening(int n, double level) {
  return std::sqrt(n / (n - 1.0)) * student_half_width(n - 1.0, level) / normal_half_width(level);
}

// The interval about `value` from its resamples, of which those that are NaN are excluded.
Estimate interval(double value, Values& resamples, double level, double wider) {
  resamples.erase(
      std::remove_if(resamples.begin(), resamples.end(), [](double v) { return std::isnan(v); }),
      resamples.end());
  if (std::isnan(value)) return {kUndefined, kUndefined, kUndefined};
  if (resamples.size() < 2) return {value, -kInfinity, kInfinity};
  const double low = quantile_of(resamples, (1 - level) / 2);
  const double high = quantile_of(resamples, (1 + level) / 2);
  return {value, value + wider * std::min(0.0, low - value),
          value + wider * std::max(0.0, high - value)};
}

// A curve with its band; `resample(b)` gives the curve of resample b.
template <class Resample>
CurveEstimate banded(Values curve, const Bootstrap& bootstrap, int bodies, Resample resample) {
  CurveEstimate out{std::move(curve), {}, {}};
  const std::size_t bins = out.value.size();
  out.low.assign(bins, -kInfinity), out.high.assign(bins, kInfinity);
  for (std::size_t i = 0; i < bins; ++i) {
    if (std::isnan(out.value[i])) out.low[i] = out.high[i] = kUndefined;
  }
  if (bodies < 2) return out;
  const auto n = static_cast<std::size_t>(bootstrap.resamples);
  std::vector<Values> columns(bins, Values(n));
  for (std::size_t b = 0; b < n; ++b) {
    const Values drawn = resample(static_cast<int>(b));
    for (std::size_t i = 0; i < bins; ++i) columns[i][b] = drawn[i];
  }
  const double wider = widening(bodies, bootstrap.level);
  for (std::size_t i = 0; i < bins; ++i) {
    const Estimate e = interval(out.value[i], columns[i], bootstrap.level, wider);
    out.low[i] = e.low, out.high[i] = e.high;
  }
  return out;
}

}  // namespace

void BodySums::append(const BodySums& other) {
  if (bins == 0) bins = other.bins, tracks.assign(other.tracks.size(), 0);
  assert(bins == other.bins || other.bins == 0);
  sum.insert(sum.end(), other.sum.begin(), other.sum.end());
  weight.insert(weight.end(), other.weight.begin(), other.weight.end());
  for (std::size_t i = 0; i < other.tracks.size(); ++i) tracks[i] += other.tracks[i];
}

std::vector<double> ratio_values(const BodySums& sums, bool relative) {
  return Resampler(sums, {.relative = relative}, 0).curve();
}

CurveEstimate ratio_curve(const BodySums& sums, const Bootstrap& bootstrap) {
  Resampler resampler(sums, bootstrap, 0);
  return banded(resampler.curve(), bootstrap, sums.bodies(),
                [&](int b) { return resampler.resample(b); });
}

CurveEstimate ratio_difference(const BodySums& first, const BodySums& second,
                               const Bootstrap& bootstrap) {
  assert(first.bins == second.bins);
  Resampler a(first, bootstrap, 0), b(second, bootstrap, 1);
  const auto minus = [](Values x, const Values& y) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] -= y[i];
    return x;
  };
  return banded(minus(b.curve(), a.curve()), bootstrap, std::min(first.bodies(), second.bodies()),
                [&](int r) { return minus(b.resample(r), a.resample(r)); });
}

Estimate ratio_functional(const BodySums& sums,
                          const std::function<double(const std::vector<double>&)>& functional,
                          const Bootstrap& bootstrap) {
  Resampler resampler(sums, bootstrap, 0);
  const double value = functional(resampler.curve());
  if (sums.bodies() < 2) return {value, -kInfinity, kInfinity};
  Values drawn;
  for (int b = 0; b < bootstrap.resamples; ++b) drawn.push_back(functional(resampler.resample(b)));
  return interval(value, drawn, bootstrap.level, widening(sums.bodies(), bootstrap.level));
}

}  // namespace lilytank
