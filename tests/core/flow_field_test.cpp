#include "lilytank/flow_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lilytank {
namespace {

// mu_x = 1 + 2x - y, a field that bilinear interpolation must give back exactly.
FlowField plane(int cells, double extent, Interpolation interpolation,
                const std::vector<bool>& measured) {
  std::vector<FlowSample> samples;
  const double h = 2 * extent / cells;
  for (int iy = 0; iy < cells; ++iy) {
    for (int ix = 0; ix < cells; ++ix) {
      const double x = (ix + 0.5) * h - extent, y = (iy + 0.5) * h - extent;
      const bool known = measured[iy * cells + ix];
      samples.push_back(known ? FlowSample{1 + 2 * x - y, x, 0.1, 0.2} : FlowSample{});
    }
  }
  return FlowField(cells, extent, samples, measured, interpolation);
}

TEST(FlowField, BilinearIsExactForAPlaneAndHoldsTheEdge) {
  const FlowField field = plane(50, 0.3, Interpolation::bilinear, std::vector<bool>(2500, true));
  for (double x = -0.29; x < 0.29; x += 0.017) {
    for (double y = -0.29; y < 0.29; y += 0.013) {
      EXPECT_NEAR(field.at(x, y).mu_x, 1 + 2 * x - y, 1e-12);
      EXPECT_NEAR(field.at(x, y).sigma_y, 0.2, 1e-12);
    }
  }
  EXPECT_NEAR(field.at(5, 0).mu_y, 0.294, 1e-12);
  EXPECT_NEAR(field.at(-5, 0).mu_y, -0.294, 1e-12);
}

TEST(FlowField, NearestGivesTheCellsOwnValue) {
  const FlowField field = plane(50, 0.3, Interpolation::nearest, std::vector<bool>(2500, true));
  EXPECT_NEAR(field.at(0.0031, 0).mu_y, 0.006, 1e-12);
  EXPECT_NEAR(field.at(0.0119, 0).mu_y, 0.006, 1e-12);
  EXPECT_NEAR(field.at(0.0121, 0).mu_y, 0.018, 1e-12);
}

TEST(FlowField, EmptyCellsAreFilledSmoothlyFromTheirNeighbours) {
  // A hole in a plane: the plane is harmonic, so the fill must give it back.
  std::vector<bool> measured(2500, true);
  for (int iy = 20; iy < 27; ++iy)
    for (int ix = 18; ix < 30; ++ix) measured[iy * 50 + ix] = false;
  const FlowField field = plane(50, 0.3, Interpolation::bilinear, measured);
  EXPECT_NEAR(field.at(-0.02, -0.02).mu_x, 1 - 0.04 + 0.02, 1e-10);
  EXPECT_NEAR(field.at(-0.02, -0.02).sigma_x, 0.1, 1e-10);
}

TEST(FlowField, RefusesWhatIsNotAField) {
  const std::vector<bool> all(4, true);
  std::vector<FlowSample> samples(4);
  EXPECT_THROW(FlowField(3, 0.3, samples, all, Interpolation::bilinear), InputError);
  EXPECT_THROW(FlowField(2, 0.3, samples, std::vector<bool>(4, false), Interpolation::bilinear),
               InputError);
  samples[2].sigma_x = -0.1;
  EXPECT_THROW(FlowField(2, 0.3, samples, all, Interpolation::bilinear), InputError);
  samples[2].sigma_x = std::nan("");
  EXPECT_THROW(FlowField(2, 0.3, samples, all, Interpolation::bilinear), InputError);
}

// What is known of the paper's tank: swirl 0.23 m/s near 13 cm and 0.1 at the wall, inflow about
// 0.1 m/s where the swirl peaks, 0.14 to 0.19 m/s deviation.
TEST(AnalyticTank, HasTheProfileOfThePapersTank) {
  const FlowField field = analytic_tank({}, Interpolation::bilinear);
  const auto ring = [&](double r) {
    double around = 0, out = 0, sigma = 0;
    for (int k = 0; k < 360; ++k) {
      const double c = std::cos(k * kPi / 180), s = std::sin(k * kPi / 180);
      const FlowSample f = field.at(r * c, r * s);
      around += (f.mu_y * c - f.mu_x * s) / 360, out += (f.mu_x * c + f.mu_y * s) / 360;
      sigma += f.sigma_x / 360;
    }
    return std::array{around, out, sigma};
  };
  EXPECT_NEAR(ring(0.135)[0], 0.23, 0.03);
  EXPECT_NEAR(ring(0.135)[1], -0.10, 0.03);
  EXPECT_NEAR(ring(0.285)[0], 0.10, 0.04);
  EXPECT_LT(ring(0.285)[1], -0.02);
  EXPECT_NEAR(ring(0.03)[1], 0, 0.02);
  EXPECT_NEAR(ring(0.18)[2], 0.19, 0.01);
  EXPECT_LT(ring(0.03)[0], 0.1);
}

TEST(AnalyticTank, MorePowerAndLowerWaterAreStronger) {
  EXPECT_DOUBLE_EQ(AnalyticTank{}.strength(), 1);
  EXPECT_GT((AnalyticTank{.pump_power = 80}.strength()), 1);
  EXPECT_GT((AnalyticTank{.water_level = -0.09}.strength()), 1);
  EXPECT_LT((AnalyticTank{.water_level = -0.07}.strength()), 1);
}

TEST(AnalyticTank, InletsPushInwardsAndAroundAndSevenAlike) {
  const FlowField field = analytic_tank({.cells = 200}, Interpolation::bilinear);
  const FlowSample at_inlet = field.at(0.28, 0.005),
                   between = field.at(0.28 * std::cos(kPi / 7), 0.28 * std::sin(kPi / 7));
  EXPECT_LT(at_inlet.mu_x, -0.08);
  const double inward_between = between.mu_x * std::cos(kPi / 7) + between.mu_y * std::sin(kPi / 7);
  EXPECT_GT(inward_between, at_inlet.mu_x + 0.05);
  for (int k = 1; k < 7; ++k) {
    const double c = std::cos(2 * kPi * k / 7), s = std::sin(2 * kPi * k / 7);
    const FlowSample f = field.at(0.2 * c, 0.2 * s), g = field.at(0.2, 0);
    EXPECT_NEAR(f.mu_x * c + f.mu_y * s, g.mu_x, 0.005);
    EXPECT_NEAR(f.mu_y * c - f.mu_x * s, g.mu_y, 0.005);
  }
}

}  // namespace
}  // namespace lilytank
