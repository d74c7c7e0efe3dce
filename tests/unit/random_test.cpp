#include "lilytank/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "math/bulk_random.hpp"
#include "lilytank/math.hpp"

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

TEST(Random, BulkNormalsFollowTheScalarGenerator) {
  alignas(64) float x[kBulkBlocks * kBulkPairs], y[kBulkBlocks * kBulkPairs];
  for (const bool along_bodies : {false, true}) {
    for (int step = 0; step < 200; ++step) {
      const Draw draw{99, Stream::gust, step, 4, 2};
      bulk_normals(draw, along_bodies, x, y);
      for (int i = 0; i < kBulkBlocks; ++i) {
        Draw one = draw;
        (along_bodies ? one.body : one.index) += static_cast<std::uint32_t>(i);
        const auto bits = random_bits(one);
        for (int j = 0; j < kBulkPairs; ++j) {
          const double u = ((bits[j] >> 8) + 0.5) * 0x1p-24;
          const double length = std::sqrt(-2 * std::log(u));
          const unsigned way = (bits[j] & 0xff) << 8 | (bits[3] >> (8 * j) & 0xff);
          const double angle = ((way & 0x3fff) - 8191.5) * kPi / 32768 + (way >> 14) * kPi / 2;
          // float32 rounds u near 1, where the length is the root of a small number.
          const double allowed = 2e-6 + 0x1p-24 / std::fmax(length, 0x1p-12);
          EXPECT_NEAR(x[j * kBulkBlocks + i], length * std::cos(angle), allowed);
          EXPECT_NEAR(y[j * kBulkBlocks + i], length * std::sin(angle), allowed);
        }
      }
    }
  }
}

TEST(Random, BulkNormalsAreNormalAndIsotropic) {
  alignas(64) float x[kBulkBlocks * kBulkPairs], y[kBulkBlocks * kBulkPairs];
  const int calls = 40000, n = calls * kBulkBlocks;
  for (int j = 0; j < kBulkPairs; ++j) {
    double sum[2] = {}, square[2] = {}, fourth[2] = {}, both = 0, beyond = 0;
    for (int step = 0; step < calls; ++step) {
      bulk_normals({5, Stream::gust, step, 0, 0}, false, x, y);
      for (int i = j * kBulkBlocks; i < (j + 1) * kBulkBlocks; ++i) {
        const double v[2] = {x[i], y[i]};
        for (int a = 0; a < 2; ++a) {
          sum[a] += v[a], square[a] += v[a] * v[a], fourth[a] += v[a] * v[a] * v[a] * v[a];
          beyond += std::fabs(v[a]) > 1.959964;
        }
        both += v[0] * v[1];
      }
    }
    const double sigma = 1 / std::sqrt(n);  // all bounds are 4 standard errors
    for (int a = 0; a < 2; ++a) {
      EXPECT_NEAR(sum[a] / n, 0, 4 * sigma);
      EXPECT_NEAR(square[a] / n, 1, 4 * sigma * std::sqrt(2));
      EXPECT_NEAR(fourth[a] / n, 3, 4 * sigma * std::sqrt(96));
    }
    EXPECT_NEAR(both / n, 0, 4 * sigma);
    EXPECT_NEAR(beyond / (2.0 * n), 0.05, 4 * std::sqrt(0.05 * 0.95 / (2.0 * n)));
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
