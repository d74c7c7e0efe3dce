#include "bulk_normals.hpp"

#include <bit>
#include <cmath>

#include "clones.hpp"

namespace lilytank {
namespace {

constexpr int kN = kBulkBlocks;

// The loops are plain, so that the compiler makes vectors of them.

// Philox4x32-10, all blocks abreast.
LILYTANK_INLINE void philox(std::uint32_t c[4][kN], std::uint32_t k0,
                                                  std::uint32_t k1) {
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < kN; ++i) {
      const std::uint64_t a = static_cast<std::uint64_t>(0xD2511F53u) * c[0][i];
      const std::uint64_t b = static_cast<std::uint64_t>(0xCD9E8D57u) * c[2][i];
      const std::uint32_t n0 = static_cast<std::uint32_t>(b >> 32) ^ c[1][i] ^ k0;
      const std::uint32_t n2 = static_cast<std::uint32_t>(a >> 32) ^ c[3][i] ^ k1;
      c[1][i] = static_cast<std::uint32_t>(b);
      c[3][i] = static_cast<std::uint32_t>(a);
      c[0][i] = n0;
      c[2][i] = n2;
    }
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
}

// Natural logarithm of x in (0, 1), float32: 2 atanh of (m - 1)/(m + 1), m in [0.71, 1.42).
LILYTANK_INLINE float log_of(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - 0x3f3504f3u;
  const float e = static_cast<float>(static_cast<std::int32_t>(bits) >> 23);
  const float m = std::bit_cast<float>((bits & 0x7fffffu) + 0x3f3504f3u);
  const float f = (m - 1) / (m + 1), q = f * f;
  const float sum = q * (1.0f / 3 + q * (1.0f / 5 + q * (1.0f / 7 + q * (1.0f / 9))));
  return e * 0.693147181f + 2 * (f + f * sum);
}

// One pair of normals from two words.
LILYTANK_INLINE void box_muller(std::uint32_t a, std::uint32_t b, float& z0,
                                                      float& z1) {
  const float u = (static_cast<float>(static_cast<std::int32_t>(a >> 8)) + 0.5f) * 0x1p-24f;
  const float length = std::sqrt(-2 * log_of(u));
  // The angle: the low 30 bits give a part of a quarter turn about 0, the top two the quarter.
  const float t = static_cast<float>(static_cast<std::int32_t>(b << 2)) * (0x1p-31f * 0.785398163f);
  const float q = t * t;
  const float sine =
      t * (1 - q * (1.0f / 6) * (1 - q * (1.0f / 20) * (1 - q * (1.0f / 42) * (1 - q * (1.0f / 72)))));
  const float cosine =
      1 - q * 0.5f * (1 - q * (1.0f / 12) * (1 - q * (1.0f / 30) * (1 - q * (1.0f / 56))));
  const bool odd = (b & 0x40000000u) != 0;
  const float x = odd ? sine : cosine, y = odd ? cosine : sine;
  // Quarter turns: (x, y) -> signs; (c,s), (-s,c), (-c,-s), (s,-c).
  const std::uint32_t quarter = b >> 30;
  const std::uint32_t flip_x = ((quarter + 1) & 2u) << 30, flip_y = (quarter & 2u) << 30;
  z0 = length * std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) ^ flip_x);
  z1 = length * std::bit_cast<float>(std::bit_cast<std::uint32_t>(y) ^ flip_y);
}

LILYTANK_CLONES void fill_normals(std::uint32_t c[4][kN], std::uint32_t k0, std::uint32_t k1,
                                  float z[4][kN]) {
  philox(c, k0, k1);
  for (int i = 0; i < kN; ++i) box_muller(c[0][i], c[1][i], z[0][i], z[1][i]);
  for (int i = 0; i < kN; ++i) box_muller(c[2][i], c[3][i], z[2][i], z[3][i]);
}

}  // namespace

void bulk_normals(const Draw& draw, bool along_bodies, float z[4][kBulkBlocks]) {
  const auto counter = counter_of(draw);
  const auto key = key_of(draw.seed);
  alignas(64) std::uint32_t c[4][kN];
  for (int i = 0; i < kN; ++i) {
    const auto k = static_cast<std::uint32_t>(i);
    c[0][i] = counter[0] + (along_bodies ? 0 : k);
    c[1][i] = counter[1] + (along_bodies ? k : 0);
    c[2][i] = counter[2];
    c[3][i] = counter[3];
  }
  fill_normals(c, key[0], key[1], z);
}

}  // namespace lilytank
