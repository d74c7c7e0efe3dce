#include "lilytank/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "math/bulk_exp.hpp"

namespace lilytank {
namespace {

TEST(Math, RotationMatchesTheCLibrary) {
  for (int i = -200000; i <= 200000; i += 7) {
    const double angle = i * 0.01234567;
    const Rot r = rotation(angle);
    EXPECT_NEAR(r.c, std::cos(angle), 3e-16 + 1e-16 * std::fabs(angle) * 1e-3);
    EXPECT_NEAR(r.s, std::sin(angle), 3e-16 + 1e-16 * std::fabs(angle) * 1e-3);
  }
}

TEST(Math, AngleInvertsRotationAndHandlesTheAxes) {
  for (int i = -3141; i <= 3141; ++i) {
    const double angle = i * 1e-3;
    EXPECT_NEAR(angle_of(rotation(angle)), angle, 5e-16 * 2);
  }
  EXPECT_DOUBLE_EQ(angle_of({-1, 0}), kPi);
  EXPECT_DOUBLE_EQ(angle_of({0, -1}), -kPi / 2);
  EXPECT_DOUBLE_EQ(angle_of({1, 0}), 0);
}

TEST(Math, ExponentialAndLogarithmMatchTheCLibrary) {
  for (double x = -740; x < 709; x += 0.37) {
    const double want = std::exp(x);
    EXPECT_NEAR(exp_portable(x), want, std::fmax(4e-16 * want, 5e-324));
  }
  for (double x = 1e-300; x < 1e300; x *= 1.7)
    EXPECT_NEAR(log_portable(x), std::log(x), 4e-16 * std::fmax(1, std::fabs(std::log(x))));
  EXPECT_EQ(exp_portable(-800), 0);
  EXPECT_TRUE(std::isinf(exp_portable(800)));
  EXPECT_TRUE(std::isnan(log_portable(-1)));
  EXPECT_NEAR(log_portable(5e-324), std::log(5e-324), 1e-12);
}

TEST(Math, ManyExponentialsHaveTheBitsOfEach) {
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> x{0, -0.0, -800, 800, infinity, -infinity, -745.2, 709.78, -745.1, 1e-300};
  for (double at = -750; at < 715; at += 0.0371) x.push_back(at);
  std::vector<double> out(x.size());
  bulk_exp(x.data(), static_cast<int>(x.size()), out.data());
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(out[i], exp_portable(x[i])) << x[i];
  for (int count = 0; count < 20; ++count) {  // in place, and nothing beyond
    std::vector<double> some(x.begin() + 30, x.begin() + 50);
    bulk_exp(some.data(), count, some.data());
    for (std::size_t i = 0; i < some.size(); ++i) {
      const double want = x[30 + i];
      EXPECT_EQ(some[i], static_cast<int>(i) < count ? exp_portable(want) : want) << i;
    }
  }
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  double one = 0;
  bulk_exp(&nothing, 1, &one);
  EXPECT_TRUE(std::isnan(one));
}

TEST(Math, PowerOfDamping) {
  EXPECT_NEAR(pow_portable(1 - 0.332, 0.025), std::pow(0.668, 0.025), 1e-15);
  EXPECT_EQ(pow_portable(0, 0.5), 0);
  EXPECT_EQ(pow_portable(0, 0), 1);
}

}  // namespace
}  // namespace lilytank
