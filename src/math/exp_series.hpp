// What e^x is computed from, one by one and many at once.
#pragma once
#include <array>
#include <cstddef>

namespace lilytank {

// ln 2 in two parts: the first has trailing zero bits, so its product with a small integer is exact
// and the reduction loses nothing.
constexpr double kLn2High = 0x1.62e42feep-1, kLn2Low = 0x1.a39ef35793c76p-33;
constexpr double kExpLeast = -745.2, kExpMost = 709.78;  // 0 below, infinity above

constexpr std::array<double, 19> inverse_factorials() {
  std::array<double, 19> out{1};
  double factorial = 1;
  for (std::size_t n = 1; n < out.size(); ++n)
    factorial *= static_cast<double>(n), out[n] = 1 / factorial;
  return out;
}
constexpr std::array<double, 19> kInverseFactorial = inverse_factorials();

}  // namespace lilytank
