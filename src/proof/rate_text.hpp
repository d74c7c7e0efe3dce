// Rates of a proof, as its reports write them.
#pragma once
#include <string>

#include "lilytank/statistics.hpp"
#include "statistics/text_table.hpp"

namespace lilytank {

/// "0.6 to 16.7 %": the 95 % Wilson interval.
inline std::string range_text(int n, int all) {
  const Estimate e = wilson(n, all);
  return fixed(100 * e.low, 1) + " to " + fixed(100 * e.high, 1) + " %";
}

/// "1 of 30"
inline std::string count_text(int n, int all) {
  return std::to_string(n) + " of " + std::to_string(all);
}

/// "1 of 30 (95 %: 0.6 to 16.7 %)"
inline std::string rate_text(int n, int all) {
  return count_text(n, all) + " (95 %: " + range_text(n, all) + ")";
}

}  // namespace lilytank
