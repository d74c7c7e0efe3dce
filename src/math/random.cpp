#include "lilytank/random.hpp"

#include <Random123/philox.h>

#include <cmath>

#include "lilytank/math.hpp"

namespace lilytank {

std::array<std::uint32_t, 4> counter_of(const Draw& draw) {
  const auto step = static_cast<std::uint64_t>(draw.step);
  return {draw.index, draw.body, static_cast<std::uint32_t>(step),
          static_cast<std::uint32_t>(step >> 32) | (static_cast<std::uint32_t>(draw.stream) << 24)};
}

std::array<std::uint32_t, 2> key_of(std::uint64_t seed) {
  return {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
}

std::array<std::uint32_t, 4> random_bits(const Draw& draw) {
  const auto counter = counter_of(draw);
  const auto key = key_of(draw.seed);
  const r123::Philox4x32::ctr_type c{{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type k{{key[0], key[1]}};
  const auto bits = r123::Philox4x32()(c, k);
  return {bits[0], bits[1], bits[2], bits[3]};
}

namespace {
// (0, 1): the middle of one of 2^52 equal parts.
double unit(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = ((static_cast<std::uint64_t>(high) << 32) | low) >> 12;
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}
}  // namespace

double uniform(const Draw& draw) {
  const auto bits = random_bits(draw);
  return unit(bits[0], bits[1]);
}

std::array<double, 2> normal_pair(const Draw& draw) {
  const auto bits = random_bits(draw);
  const double length = std::sqrt(-2 * log_portable(unit(bits[0], bits[1])));
  const Rot direction = rotation(2 * kPi * unit(bits[2], bits[3]));
  return {length * direction.c, length * direction.s};
}

std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t run) {
  // A block of its own: stream 0 is never used for draws.
  const Draw draw{seed, static_cast<Stream>(0), static_cast<std::int64_t>(run & 0xffffffffffffull),
                  static_cast<std::uint32_t>(run >> 48), 0};
  const auto bits = random_bits(draw);
  return (static_cast<std::uint64_t>(bits[0]) << 32) | bits[1];
}

}  // namespace lilytank
