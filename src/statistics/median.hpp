// Numbers by their rank, and the middle one.
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace lilytank {

/// The number with `rank` smaller ones; takes numbers, not NaN, more than `rank`.
inline double ranked(std::vector<double> values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Of an even count the upper one of the middle two; NaN of none. Takes numbers, not NaN.
inline double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t middle = values.size() / 2;
  return ranked(std::move(values), middle);
}

}  // namespace lilytank
