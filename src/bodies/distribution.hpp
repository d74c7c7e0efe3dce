// Coefficients of many bodies, or of many runs, as a distribution.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lilytank/diagnosis.hpp"

namespace lilytank::bodies {

/// Values that differ by more than their errors: the mean and the standard deviation of what they
/// are drawn from, each with its 95 % interval.
struct Distribution {
  double mean = 0, mean_low = 0, mean_high = 0;
  double deviation = 0, deviation_low = 0, deviation_high = 0;
};
/// From values with 95 % intervals, three or more, under a random-effects model [DerSimonian and
/// Laird 1986]; the mean's interval by Student's t [Knapp and Hartung 2003], the deviation's by the
/// Q-profile method [Viechtbauer 2007].
Distribution distribution_of(std::span<const FoundParameter> values);

/// A power law of values over sizes, with the 95 % interval of its exponent.
struct Growth {
  double exponent = 0, low = 0, high = 0;
};
/// From values with 95 % intervals, and the sizes of what they belong to. Weighted least squares
/// with a relative scatter beside the errors that makes chi^2 its degrees of freedom [Paule and
/// Mandel 1982]; the interval is that of the chi^2 profile, by Student's t. Nothing for fewer than
/// four values, for sizes that are not positive or differ by less than a factor of 1.5, and where
/// the interval exceeds +-6.
std::optional<Growth> growth_over(std::span<const double> sizes,
                                  std::span<const FoundParameter> values);

/// Groups that have a line each.
inline constexpr std::size_t kMostListed = 12;

/// The parameters `of` all groups as a report lists them: up to kMostListed groups each value; of
/// more the median, the smallest and the largest of each path. From three on also the distribution.
/// `number`: of the groups; `groups`: "bodies" or "runs".
std::vector<FoundParameter> summarized(const std::vector<FoundParameter>& of, std::size_t number,
                                       const std::string& groups);

}  // namespace lilytank::bodies
