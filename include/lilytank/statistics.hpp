// Statistics of assembly experiments: proportions, rates, censored times, curves, pairs.
#pragma once
#include <cstdint>
#include <vector>

namespace lilytank {

/// An estimate with a two-sided confidence interval.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// Wilson's score interval of a proportion; n = 0 gives 0 .. 1.
Estimate wilson(std::int64_t successes, std::int64_t n, double level = 0.95);

/// Events per second from `events` in `exposure` seconds, with Garwood's exact Poisson interval.
Estimate poisson_rate(std::int64_t events, double exposure, double level = 0.95);

/// A time that was observed, or that ended unobserved (censored).
struct Duration {
  double time = 0;      ///< s
  bool observed = true;
};

/// Kaplan and Meier's survival curve: after time[i], survival[i], with Greenwood's variance and a
/// log-log interval.
struct Survival {
  std::vector<double> time, survival, low, high;
  std::vector<std::int64_t> at_risk, events;  ///< before and at time[i]
  std::vector<double> variance;               ///< Greenwood's, of survival[i]
};
Survival kaplan_meier(std::vector<Duration> durations, double level = 0.95);

/// Area under the survival curve to `horizon`: the mean of min(T, horizon), with its normal interval.
Estimate restricted_mean(const Survival& curve, double horizon, double level = 0.95);

/// Log-rank test that groups have one survival curve.
struct TestResult {
  double statistic = 0;
  double degrees = 0;
  double p = 1;
};
TestResult log_rank(const std::vector<std::vector<Duration>>& groups);

/// Mean with Student's interval; n < 2 gives an unbounded one.
Estimate mean_interval(const std::vector<double>& values, double level = 0.95);

/// Mean of a - b over pairs, with Student's interval, and the variance that pairing saved:
/// var(a) + var(b) over var(a - b).
struct PairedComparison {
  Estimate difference;
  double p = 1;          ///< Student's, two-sided
  double saving = 1;
};
PairedComparison compare_pairs(const std::vector<double>& a, const std::vector<double>& b,
                               double level = 0.95);

/// Mean of runs' step curves at given times with a pointwise percentile-bootstrap band over runs.
struct CurveBand {
  std::vector<double> time, mean, low, high;
};
/// `steps[r]` are the times at which run r's count rose by one; `seed` fixes the resampling.
CurveBand yield_band(const std::vector<std::vector<double>>& steps, const std::vector<double>& times,
                     std::uint64_t seed, int resamples = 2000, double level = 0.95);

}  // namespace lilytank
