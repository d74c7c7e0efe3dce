#include "lilytank/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "lilytank/math.hpp"
#include "math/bulk_random.hpp"

namespace lilytank {
namespace {

// Known answers published with Philox4x32-10 for counter and key of all zeros.
TEST(Random, PhiloxKnownAnswer) {
  const Draw draw{0, static_cast<Stream>(0), 0, 0, 0};
  const auto bits = random_bits(draw);
  EXPECT_EQ(bits[0], 0x6627e8d5u);
  EXPECT_EQ(bits[1], 0xe169c58du);
  EXPECT_EQ(bits[2], 0xbc57ac4cu);
  EXPECT_EQ(bits[3], 0x9b00dbd8u);
}

TEST(Random, EveryPartOfADrawMatters) {
  const Draw base{1, Stream::gust, 5, 7, 9};
  Draw seed = base, stream = base, step = base, high = base, body = base, index = base;
  seed.seed = 2, stream.stream = Stream::stochastic, step.step = 6, high.step = 5 + (1ll << 40);
  body.body = 8, index.index = 10;
  std::set<double> values;
  for (const Draw& d : {base, seed, stream, step, high, body, index}) values.insert(uniform(d));
  EXPECT_EQ(values.size(), 7u);
}

TEST(Random, UniformAndNormalHaveTheirMoments) {
  const int n = 200000;
  double mean = 0, square = 0, normal = 0, second = 0, fourth = 0, both = 0;
  for (int i = 0; i < n; ++i) {
    const double u = uniform({3, Stream::gust, i});
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    mean += u, square += u * u;
    const auto z = normal_pair({3, Stream::stochastic, i});
    normal += z[0], second += z[0] * z[0], fourth += z[0] * z[0] * z[0] * z[0], both += z[0] * z[1];
  }
  const double sigma = 1 / std::sqrt(n);  // all bounds are 4 standard errors
  EXPECT_NEAR(mean / n, 0.5, 4 * sigma * std::sqrt(1.0 / 12));
  EXPECT_NEAR(square / n, 1.0 / 3, 4 * sigma * std::sqrt(4.0 / 45));
  EXPECT_NEAR(normal / n, 0, 4 * sigma);
  EXPECT_NEAR(second / n, 1, 4 * sigma * std::sqrt(2));
  EXPECT_NEAR(fourth / n, 3, 4 * sigma * std::sqrt(96));
  EXPECT_NEAR(both / n, 0, 4 * sigma);
}

// Number k of a body by the rule in bulk_random.hpp, in double precision.
double bulk_number(Draw draw, int body, int k) {
  draw.body += static_cast<std::uint32_t>(body), draw.index += static_cast<std::uint32_t>(k / 8);
  const std::uint32_t bits = random_bits(draw)[k % 8 / 2];
  const double length = std::sqrt(-2 * std::log(((bits >> 13) + 0.5) * 0x1p-19));
  const double angle = ((bits & 0x7ff) - 1023.5) * kPi / 4096, sign = bits >> 12 & 1 ? -1 : 1;
  const bool swapped = (bits >> 11 & 1) != 0;
  return sign * length * ((k % 2 == 1) != swapped ? std::sin(angle) : std::cos(angle));
}

// The polynomials' errors, 1e-5 each, and float32's rounding of u near 1, where the length is the
// root of a small number.
TEST(Random, BulkNormalsFollowTheScalarGenerator) {
  alignas(64) float z[50 * kBulkBodies];
  for (const int count : {2, 4, 6, 8, 10, 16, 44, 50}) {
    for (int step = 0; step < 100; ++step) {
      const Draw draw{99, Stream::gust, step, 4, 2};
      bulk_normals(draw, count, z);
      for (int i = 0; i < kBulkBodies; ++i) {
        for (int k = 0; k < count; ++k) {
          const double x = bulk_number(draw, i, k), y = bulk_number(draw, i, k ^ 1);
          const double length = std::hypot(x, y);
          const double allowed = 3e-5 * length + 0x1p-24 / std::fmax(length, 0x1p-12);
          EXPECT_NEAR(z[k * kBulkBodies + i], x, allowed);
        }
      }
    }
  }
}

TEST(Random, BulkWordsAreTheScalarGenerators) {
  alignas(64) std::uint32_t words[kBulkBodies];
  for (int step = 0; step < 100; ++step) {
    const Draw draw{7, Stream::initiative, step, 48, 0};
    bulk_words(draw, words);
    for (std::uint32_t i = 0; i < kBulkBodies; ++i) {
      Draw one = draw;
      one.body += i;
      EXPECT_EQ(words[i], random_bits(one)[0]);
    }
  }
}

TEST(Random, BulkNormalsAreNormalAndIndependent) {
  constexpr int kCount = 12, kCalls = 40000, n = kCalls * kBulkBodies;
  alignas(64) float z[kCount * kBulkBodies];
  double sum[kCount] = {}, square[kCount] = {}, fourth[kCount] = {}, next[kCount] = {};
  double beyond[kCount] = {};
  for (int step = 0; step < kCalls; ++step) {
    bulk_normals({5, Stream::gust, step, 0, 0}, kCount, z);
    for (int k = 0; k < kCount; ++k) {
      for (int i = 0; i < kBulkBodies; ++i) {
        const double v = z[k * kBulkBodies + i], w = z[(k + 1) % kCount * kBulkBodies + i];
        sum[k] += v, square[k] += v * v, fourth[k] += v * v * v * v, next[k] += v * w;
        beyond[k] += std::fabs(v) > 1.959964;
      }
    }
  }
  const double sigma = 1 / std::sqrt(n);  // all bounds are 4 standard errors
  for (int k = 0; k < kCount; ++k) {
    EXPECT_NEAR(sum[k] / n, 0, 4 * sigma);
    EXPECT_NEAR(square[k] / n, 1, 4 * sigma * std::sqrt(2));
    EXPECT_NEAR(fourth[k] / n, 3, 4 * sigma * std::sqrt(96));
    EXPECT_NEAR(next[k] / n, 0, 4 * sigma);
    EXPECT_NEAR(beyond[k] / n, 0.05, 4 * std::sqrt(0.05 * 0.95 / n));
  }
}

TEST(Random, DerivedSeedsDiffer) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t run = 0; run < 1000; ++run) seeds.insert(derived_seed(1, run));
  EXPECT_EQ(seeds.size(), 1000u);
  EXPECT_NE(derived_seed(1, 0), derived_seed(2, 0));
}

}  // namespace
}  // namespace lilytank
