#include "lilytank/math.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

#include "exp_series.hpp"

namespace lilytank {
namespace {

// pi/2 in two parts, as ln 2 is.
constexpr double kHalfPiHigh = 0x1.921fb544p+0, kHalfPiLow = 0x1.0b4611a626331p-34;

// Taylor's sum of x^n / n! with alternating signs, n = first, first + 2, ... up to last, over
// x^first: good to rounding on |x| <= pi/4. Powers of x^4 by themselves, so that neither sum waits
// for the other.
template <std::size_t first, std::size_t last>
double alternating(double q) {
  static_assert((last - first) % 4 == 2);
  const double q2 = q * q;
  double even = kInverseFactorial[last - 2], odd = kInverseFactorial[last];
  for (std::size_t n = last - 4; n > first; n -= 4) {
    even = even * q2 + kInverseFactorial[n - 2], odd = odd * q2 + kInverseFactorial[n];
  }
  return even - q * odd;
}

double sine_near_zero(double x) {
  const double q = x * x;
  return x - x * (q * alternating<3, 17>(q));
}

double cosine_near_zero(double x) {
  const double q = x * x;
  return 1 - q * alternating<2, 16>(q);
}

}  // namespace

Rot rotation(double angle) {
  const double turns = std::floor(angle / (kHalfPiHigh + kHalfPiLow) + 0.5);
  const double rest = (angle - turns * kHalfPiHigh) - turns * kHalfPiLow;
  const Rot small{cosine_near_zero(rest), sine_near_zero(rest)};
  // Any angle is as likely as another, so branches on the quadrant would be guessed wrong.
  static constexpr double kSignC[] = {1, -1, -1, 1}, kSignS[] = {1, 1, -1, -1};
  const auto quadrant = static_cast<std::size_t>(turns - 4 * std::floor(turns / 4));
  const double both[] = {small.c, small.s};
  return {kSignC[quadrant] * both[quadrant & 1], kSignS[quadrant] * both[1 - (quadrant & 1)]};
}

double angle_of(Rot r) {
  // A first guess good to 0.004 rad, and what is left by the series of the arc tangent. Tables
  // instead of branches, as above.
  static constexpr double kSign[] = {1, -1}, kQuarter[] = {0, kPi / 2}, kHalf[] = {0, kPi};
  const double ax = std::fabs(r.c), ay = std::fabs(r.s);
  if (ax == 0 && ay == 0) return 0;
  const double t = std::min(ax, ay) / std::max(ax, ay);
  double guess = t * (kPi / 4 + 0.273 * (1 - t));
  const std::size_t steep = ay >= ax, left_half = r.c < 0, below = r.s < 0;
  guess = kQuarter[steep] + kSign[steep] * guess;
  guess = kHalf[left_half] + kSign[left_half] * guess;
  guess *= kSign[below];
  const Rot left = between(rotation(guess), r);
  const double x = left.s / left.c, q = x * x;
  guess += x - x * q * (1.0 / 3 - q * (1.0 / 5 - q * (1.0 / 7)));
  return guess > kPi ? kPi : guess <= -kPi ? kPi : guess;
}

double exp_portable(double x) {
  if (!(x > kExpLeast)) return x != x ? x : 0;
  if (x > kExpMost) return std::numeric_limits<double>::infinity();
  const double k = std::floor(x / (kLn2High + kLn2Low) + 0.5);
  const double rest = (x - k * kLn2High) - k * kLn2Low;
  // Taylor's sum, even and odd powers by themselves: neither waits for the other.
  const double q = rest * rest;
  double even = kInverseFactorial[14], odd = kInverseFactorial[13];
  for (std::size_t n = 12; n >= 2; n -= 2) {
    even = even * q + kInverseFactorial[n], odd = odd * q + kInverseFactorial[n - 1];
  }
  const double sum = 1 + (rest * odd + q * even);
  // Two factors, so that results below the normal range are reached too.
  const int half = static_cast<int>(k) / 2, other = static_cast<int>(k) - half;
  const auto power = [](int e) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52);
  };
  return sum * power(half) * power(other);
}

double log_portable(double x) {
  if (!(x > 0)) {
    return x == 0 ? -std::numeric_limits<double>::infinity()
                  : std::numeric_limits<double>::quiet_NaN();
  }
  if (x == std::numeric_limits<double>::infinity()) return x;
  int shift = 0;
  if (x < 0x1p-1022) x *= 0x1p54, shift = -54;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  int e = static_cast<int>(bits >> 52) - 1023 + shift;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffull) | 0x3ff0000000000000ull);
  if (m > 1.4142135623730951) m *= 0.5, ++e;
  // ln m = 2 atanh((m - 1) / (m + 1)), |argument| <= 0.172.
  const double f = (m - 1) / (m + 1), q = f * f;
  double sum = 0;
  for (int k = 23; k >= 3; k -= 2) sum = q * (1.0 / k + sum);
  return e * kLn2High + (2 * f + (2 * f * sum + e * kLn2Low));
}

double pow_portable(double base, double exponent) {
  if (exponent == 0) return 1;
  if (base == 0) return 0;
  return exp_portable(exponent * log_portable(base));
}

}  // namespace lilytank
