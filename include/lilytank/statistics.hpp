// Statistics of assembly experiments: proportions, rates, censored times, curves, pairs.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

namespace lilytank {

/// An estimate with a two-sided confidence interval. Where the data say nothing, the value is NaN;
/// where they set no bound, an end is infinite, or the end of what is possible.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// Wilson's score interval of a proportion [Wilson, J. Am. Stat. Assoc. 22, 1927]; n = 0 gives
/// 0 .. 1.
Estimate wilson(std::int64_t successes, std::int64_t n, double level = 0.95);

/// Events per second from `events` in `exposure` seconds, with Garwood's exact Poisson interval
/// [Garwood, Biometrika 28, 1936]. No exposure gives 0 .. infinity.
Estimate poisson_rate(std::int64_t events, double exposure, double level = 0.95);

/// A time that was observed, or that ended unobserved (censored).
struct Duration {
  double time = 0;  ///< s
  bool observed = true;
};

/// Kaplan and Meier's survival curve [J. Am. Stat. Assoc. 53, 1958]: one entry for each time at
/// which something was observed or censored; from time[i] on, survival[i] is left. At equal times
/// events come before censoring. The interval is the log-log one; before the first event, where
/// that is undefined, Clopper and Pearson's for no event in at_risk[i]; where nobody is left,
/// 0 .. the upper end before.
struct Survival {
  /// Times (s), ascending, and the curve with its interval from there on.
  std::vector<double> time, survival, low, high;
  std::vector<std::int64_t> at_risk;           ///< just before time[i]
  std::vector<std::int64_t> events, censored;  ///< at time[i]
  std::vector<double> variance;                ///< Greenwood's, of survival[i]
};
/// Durations in any order. An empty list gives an empty curve.
Survival kaplan_meier(std::vector<Duration> durations, double level = 0.95);

/// Area under the survival curve to `horizon` (s): the mean of min(T, horizon), with its normal
/// interval from Greenwood's variance, cut to 0 .. horizon. Beyond its last time the curve is taken
/// to stay as it is, so `horizon` should not lie beyond what was watched. Without any event the
/// lower end is horizon * (the lower end of the survival there); a curve of one gives 0 .. horizon.
Estimate restricted_mean(const Survival& curve, double horizon, double level = 0.95);

/// A test of significance; `degrees` 0 says that the data could not tell anything.
struct TestResult {
  /// Value of the statistic under the test's law.
  double statistic = 0;
  double degrees = 0;
  /// Probability of a statistic at least as large under the null hypothesis.
  double p = 1;
};
/// Log-rank test that groups have one survival curve [Mantel, Cancer Chemother. Rep. 50, 1966]:
/// chi-squared with one degree of freedom less than there are groups that an event could meet.
TestResult log_rank(const std::vector<std::vector<Duration>>& groups);

/// Mean with Student's interval; n < 2 gives an unbounded one.
Estimate mean_interval(const std::vector<double>& values, double level = 0.95);
/// The same of values within [least, most]. Where all n are equal they have no variance, but others
/// may have a probability of up to 1 - ((1 - level) / 2)^(1 / n) [Clopper and Pearson]: the
/// interval holds the means that leaves possible.
Estimate bounded_mean_interval(const std::vector<double>& values, double least, double most,
                               double level = 0.95);

/// Mean of a - b over pairs, with Student's interval, and the variance that pairing saved:
/// var(a) + var(b) over var(a - b).
struct PairedComparison {
  Estimate difference;
  /// Student's, two-sided; the signs' where all differences are equal; NaN for fewer than two
  /// pairs, which have no spread to judge a difference by.
  double p = std::numeric_limits<double>::quiet_NaN();
  /// As many times the runs would be needed without pairs; NaN for fewer than two pairs.
  double saving = std::numeric_limits<double>::quiet_NaN();
};
/// `a` and `b` are of equal length, pair by pair.
PairedComparison compare_pairs(const std::vector<double>& a, const std::vector<double>& b,
                               double level = 0.95);

/// Mean of runs' step curves at given times with a pointwise percentile-bootstrap band over runs.
struct CurveBand {
  std::vector<double> time, mean, low, high;
};
/// `steps[r]` are the times at which run r's count rose by one; `times` rise; `seed` fixes the
/// resampling. One run gives an unbounded band, none a mean of NaN.
CurveBand yield_band(const std::vector<std::vector<double>>& steps,
                     const std::vector<double>& times, std::uint64_t seed, int resamples = 2000,
                     double level = 0.95);

}  // namespace lilytank
