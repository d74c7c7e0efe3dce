#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/metrics.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

// Circular motion: MSD = 2 R^2 (1 - cos(omega t)).
TEST(Msd, CircleMatchesItsClosedForm) {
  Trajectory t{.bodies = 1, .modules = 1};
  for (int f = 0; f < 4000; ++f) {
    t.time.push_back(0.025 * f);
    t.x.push_back(static_cast<float>(0.1 * std::cos(1.3 * 0.025 * f)));
    t.y.push_back(static_cast<float>(0.1 * std::sin(1.3 * 0.025 * f)));
    t.theta.push_back(0);
  }
  for (const Origins origins : {Origins::first, Origins::all}) {
    const MsdCurve c = mean_squared_displacement(t, 0, 1, {0, 40, 80, 400, 5000}, origins);
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(c.msd[i], 2 * 0.01 * (1 - std::cos(1.3 * c.lag[i])), 1e-7);
    EXPECT_EQ(c.count[4], 0);
  }
}

// A random walk: MSD = steps * 2 sigma^2, with the error of the mean over independent bodies.
TEST(Msd, RandomWalkGrowsLinearlyFromItsFirstFrame) {
  const int bodies = 4000, frames = 50;
  Trajectory t{.bodies = bodies, .modules = bodies};
  std::vector<double> x(bodies, 0), y(bodies, 0);
  for (int f = 0; f < frames; ++f) {
    t.time.push_back(f);
    for (int i = 0; i < bodies; ++i) {
      t.x.push_back(static_cast<float>(x[i])), t.y.push_back(static_cast<float>(y[i]));
      t.theta.push_back(0);
      const auto z = normal_pair({1, Stream::gust, f, static_cast<std::uint32_t>(i)});
      x[i] += z[0], y[i] += z[1];
    }
  }
  const MsdCurve c = mean_squared_displacement(t, 0, bodies, {1, 10, 49}, Origins::first);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(c.msd[i], 2 * c.lag[i], 4 * 2 * c.lag[i] / std::sqrt(double(bodies)));
}

}  // namespace
}  // namespace lilytank
