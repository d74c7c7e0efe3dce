// Are samples normally distributed? The Kolmogorov-Smirnov test as the paper's Fig. 3 uses it, as
// it has to be where mean and deviation come from the same samples, and over many tests at once.
#pragma once
#include <vector>

namespace lilytank {

/// A normal distribution with the samples' own mean and deviation against their steps.
struct NormalityTest {
  /// Number of samples.
  int samples = 0;
  double mean = 0, deviation = 0;  ///< deviation with n - 1
  /// Largest difference of the two distribution functions.
  double distance = 0;
  /// Kolmogorov's probability of at least this distance, for a mean and deviation known beforehand
  /// [Stephens, J. R. Stat. Soc. B 32, 1970]. Far too large here: it almost never rejects.
  double raw_p = 1;
  /// The same for a mean and deviation taken from the samples [Lilliefors, J. Am. Stat. Assoc. 62,
  /// 1967]: uniform for independent normal samples, between 0.0001 and 0.9999.
  double p = 1;
};
/// Tests samples. Fewer than four, or all the same, give p = raw_p = 1 and a distance of 0.
NormalityTest test_normality(std::vector<double> samples);

/// Probability that n >= 4 independent normal samples lie at least this far from the normal
/// distribution with their own mean and deviation: interpolated in a table that was simulated
/// (600,000 samples for n <= 30, 100,000 for n = 400), with Stephens' scaling of the distance [J.
/// Am. Stat. Assoc. 69, 1974] between and beyond its rows. Cut to 0.0001 .. 0.9999.
double lilliefors_p(double distance, int n);
/// Kolmogorov's limiting distribution with Stephens' correction for small n.
double kolmogorov_p(double distance, int n);

/// Which hypotheses to reject so that the expected share of false ones among the rejected is at
/// most `rate` [Benjamini and Hochberg, J. R. Stat. Soc. B 57, 1995]. NaN are no tests.
std::vector<bool> false_discovery(const std::vector<double>& p, double rate);

}  // namespace lilytank
