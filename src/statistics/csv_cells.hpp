// Cells of tidy tables.
#pragma once
#include <string>

#include "lilytank/statistics.hpp"

namespace lilytank {

/// Ten digits: more than any statistic has, and few enough that last bits do not show. Empty where
/// it is not finite.
std::string cell(double value);
/// Text as RFC 4180 has it: in quotes where it must be.
std::string cell(const std::string& text);
/// "value,low,high".
std::string cells(const Estimate& estimate);

}  // namespace lilytank
