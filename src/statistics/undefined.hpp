// What numbers are that the data do not determine.
#pragma once
#include <limits>

namespace lilytank {

/// No data, or too few of them.
inline constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
/// The end of an interval that the data do not bound.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace lilytank
