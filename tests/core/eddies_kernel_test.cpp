// Eddies against their waves, one after the other in double precision.
#include "forces/eddies_kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/math.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr float kHalf = 0.0175f;

// Waves of a length of 5 mm, the shortest there is, to 3 turns in 10 cm.
EddyWaves some_waves(std::uint64_t seed) {
  EddyWaves out;
  for (std::uint32_t m = 0; m < kWaves; ++m) {
    const auto number = [&](std::uint32_t k) {
      return static_cast<float>(normal_pair({seed, Stream::eddies, 0, m, k})[0]);
    };
    out.kx[m] = 30 * number(0), out.ky[m] = 30 * number(1), out.offset[m] = 0.1f * number(2);
    out.ax[m] = 0.2f * number(3), out.ay[m] = 0.2f * number(4);
  }
  find_differences(kHalf, out);
  return out;
}

struct Flow {
  double x = 0, y = 0;
  double error = 0;  // that the sums may have
};
Flow flow_at(const EddyWaves& w, double x, double y) {
  Flow out;
  for (int m = 0; m < kWaves; ++m) {
    const double kx = static_cast<double>(w.kx[m]) * x, ky = static_cast<double>(w.ky[m]) * y;
    const double swing = std::cos(2 * kPi * (kx + ky + static_cast<double>(w.offset[m])));
    const double ax = static_cast<double>(w.ax[m]), ay = static_cast<double>(w.ay[m]);
    out.x += ax * swing, out.y += ay * swing;
    out.error += (std::fabs(ax) + std::fabs(ay)) * (3e-6 + 2e-6 * (std::fabs(kx) + std::fabs(ky)));
  }
  return out;
}

TEST(EddiesKernel, SumsItsWavesAndTheirDifferences) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const EddyWaves waves = some_waves(seed);
    EddyBlock block{};
    for (int i = 0; i < kBulkBodies; ++i) {
      const auto z = normal_pair({seed, Stream::start_pose, i, 0, 0});
      block.x[i] = static_cast<float>(0.1 * z[0]), block.y[i] = static_cast<float>(0.1 * z[1]);
    }
    sum_eddies(waves, block);
    for (int i = 0; i < kBulkBodies; ++i) {
      const double x = static_cast<double>(block.x[i]), y = static_cast<double>(block.y[i]);
      const double h = static_cast<double>(kHalf);
      const Flow here = flow_at(waves, x, y);
      EXPECT_NEAR(static_cast<double>(block.ux[i]), here.x, here.error);
      EXPECT_NEAR(static_cast<double>(block.uy[i]), here.y, here.error);
      const double y_by_x = (flow_at(waves, x + h, y).y - flow_at(waves, x - h, y).y) / (2 * h);
      const double x_by_y = (flow_at(waves, x, y + h).x - flow_at(waves, x, y - h).x) / (2 * h);
      EXPECT_NEAR(static_cast<double>(block.y_by_x[i]), y_by_x, 2 * here.error / h);
      EXPECT_NEAR(static_cast<double>(block.x_by_y[i]), x_by_y, 2 * here.error / h);
    }
  }
}

}  // namespace
}  // namespace lilytank
