// Quantiles and tail probabilities of the normal, Student's t and the chi-squared distribution, by
// Boost.Math where nothing else is said.
#pragma once

namespace lilytank {

/// x with P(N <= x) = `p`, of a standard normal N; 0 < p < 1.
double normal_quantile(double p);

/// Half width of a two-sided interval of `level` in standard errors: 1.960 for 0.95; 0 < level < 1.
double normal_half_width(double level = 0.95);

/// The same by Student's t of `freedom` > 0 degrees, which need not be whole: 3.182 for 3 degrees.
double student_half_width(double freedom, double level = 0.95);

/// P(|T| > t) of Student's t with `freedom` degrees; t >= 0.
double student_tail(double t, double freedom);

/// x with P(X <= x) = `p`, of a chi-squared X with `freedom` > 0 degrees; 0 <= p < 1.
double chi_squared_quantile(double p, double freedom);

/// x with P(X > x) = `p`, accurate for small p > 0.
double chi_squared_upper_quantile(double p, double freedom);

/// P(X > square) of a chi-squared X with `freedom` degrees; square >= 0.
double chi_squared_tail(double square, double freedom);

/// The normal number with the probability of a chi-squared one of so many degrees of freedom
/// [Wilson and Hilferty, PNAS 17, 1931]; of one degree its root. Below the median it is
/// negative. Far in the tail it is too small: 11.7 of 200 with 5 degrees, exact two-sided 13.5.
double chi_squared_z(double square, int freedom);

}  // namespace lilytank
