#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "lilytank/statistics.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

// Greenwood's sum of d / (n (n - d)) as it grows along the curve.
double greenwood_term(std::int64_t events, std::int64_t at_risk) {
  const auto d = static_cast<double>(events), n = static_cast<double>(at_risk);
  return events < at_risk ? d / (n * (n - d)) : 0;
}

// Interval of one point of a survival curve; `before` is the interval of the point before it.
Estimate survival_interval(double survival, double greenwood, std::int64_t at_risk, double z,
                           double tail, const Estimate& before) {
  if (survival >= 1) {
    // No event in n: Clopper and Pearson's lower end.
    return {survival, std::pow(tail, 1 / static_cast<double>(at_risk)), 1};
  }
  if (survival <= 0) return {0, 0, before.high};
  const double log_s = std::log(survival);
  const double reach = z * std::sqrt(greenwood) / std::fabs(log_s);
  return {survival, std::exp(log_s * std::exp(reach)), std::exp(log_s * std::exp(-reach))};
}

}  // namespace

Survival kaplan_meier(std::vector<Duration> durations, double level) {
  std::sort(durations.begin(), durations.end(),
            [](const Duration& a, const Duration& b) { return a.time < b.time; });
  const double z = normal_half_width(level), tail = (1 - level) / 2;
  Survival curve;
  Estimate now{1, 0, 1};
  double greenwood = 0;
  for (std::size_t i = 0; i < durations.size();) {
    const double time = durations[i].time;
    const auto at_risk = static_cast<std::int64_t>(durations.size() - i);
    std::int64_t events = 0, censored = 0;
    for (; i < durations.size() && durations[i].time == time; ++i) {
      ++(durations[i].observed ? events : censored);
    }
    greenwood += greenwood_term(events, at_risk);
    const double s =
        now.value * static_cast<double>(at_risk - events) / static_cast<double>(at_risk);
    now = survival_interval(s, greenwood, at_risk, z, tail, now);
    curve.time.push_back(time);
    curve.survival.push_back(s);
    curve.low.push_back(now.low);
    curve.high.push_back(now.high);
    curve.at_risk.push_back(at_risk);
    curve.events.push_back(events);
    curve.censored.push_back(censored);
    curve.variance.push_back(s * s * greenwood);
  }
  return curve;
}

Estimate restricted_mean(const Survival& curve, double horizon, double level) {
  assert(horizon >= 0);
  const double z = normal_half_width(level);
  if (curve.time.empty()) return {std::numeric_limits<double>::quiet_NaN(), 0, horizon};
  const auto used = static_cast<std::size_t>(
      std::upper_bound(curve.time.begin(), curve.time.end(), horizon) - curve.time.begin());
  // From the horizon back: `area` is the area under the curve to the right of time[i].
  double area = 0, variance = 0, end = horizon;
  std::int64_t events = 0;
  for (std::size_t i = used; i-- > 0;) {
    area += curve.survival[i] * (end - curve.time[i]);
    variance += area * area * greenwood_term(curve.events[i], curve.at_risk[i]);
    events += curve.events[i];
    end = curve.time[i];
  }
  area += end;
  if (curve.at_risk[0] < 2) return {area, 0, horizon};
  if (events == 0) {
    // The variance says nothing; but the mean is at least horizon * S(horizon).
    const auto at_risk = static_cast<double>(curve.at_risk[used > 0 ? used - 1 : 0]);
    return {area, horizon * std::pow((1 - level) / 2, 1 / at_risk), horizon};
  }
  const double half = z * std::sqrt(variance);
  return {area, std::max(0.0, area - half), std::min(horizon, area + half)};
}

}  // namespace lilytank
