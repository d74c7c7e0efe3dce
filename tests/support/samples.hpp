// Samples of known distributions for tests of statistics.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>

#include "lilytank/random.hpp"

namespace lilytank::test {

inline constexpr double kInf = std::numeric_limits<double>::infinity();
inline constexpr double kZ = 1.959963984540054;  // 97.5 % of the standard normal

inline double uniform_at(std::uint64_t set, int i, std::uint32_t what = 0) {
  return uniform({20240607 + set, Stream::evaluation, i, what, 0});
}
inline double exponential_at(std::uint64_t set, int i, std::uint32_t what = 0) {
  return -std::log(uniform_at(set, i, what));
}

}  // namespace lilytank::test
