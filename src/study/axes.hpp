// The values of an axis that is given by its ends.
#pragma once
#include <vector>

#include "study/study_file.hpp"

namespace lilytank {

/// range.count values from one end to the other, both included.
std::vector<double> range_values(const AxisRange& range);

/// `samples` values, one at a random place in each of as many parts of equal length (or, on a log
/// scale, ratio), in random order. Different axes of a study are independent. Whole numbers are
/// rounded afterwards.
std::vector<double> latin_values(const AxisRange& range, int samples, std::uint64_t seed, int axis);

}  // namespace lilytank
