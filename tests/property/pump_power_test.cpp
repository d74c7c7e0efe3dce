// The built-in tank follows the trends of the paper's Fig. 4: more pump power, or lower water,
// gives a faster oscillation of the MSD and a lower plateau.
#include <gtest/gtest.h>

#include "lilytank/random.hpp"
#include "lilytank/study.hpp"
#include "support/msd.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

struct Figure {
  double first_maximum = 0;  ///< s, lag of the first maximum of the MSD: half an orbit
  double plateau = 0;        ///< m^2, mean of the MSD from 30 to 60 s
};

// 24 balls as in the paper's measurement, with Table 1's figures for balls.
Figure measure(double power, double level) {
  Model model = standard_model();
  model.field = std::make_shared<const FlowField>(
      analytic_tank({.pump_power = power, .water_level = level}, Interpolation::bilinear));
  model.module.count = 0, model.ball.count = 24;
  model.flow.K_v = 1.24;
  model.forces = {test::force("ball_drag", {2.266}), test::force("stochastic", {19.525e-3}),
                  test::force("damping", {0.3483, 0.2476})};
  std::vector<int> lags;
  for (int lag = 4; lag <= 2400; lag += 4) lags.push_back(lag);
  const int runs = 3;
  std::vector<MsdCurve> curves(runs);
  for_each_world(runs, 0, [&](int run) {
    World world(model, derived_seed(9, run));
    test::advance(world, 20);
    Trajectory track;
    for (int i = 0; i < 8000; ++i) {
      world.step();
      append_poses(world, track);
    }
    curves[run] =
        mean_squared_displacement(as_recording(track, BodyKind::ball), lags, Origins::all);
  });
  Figure figure;
  std::vector<double> msd(lags.size(), 0);
  for (const MsdCurve& curve : curves)
    for (std::size_t i = 0; i < msd.size(); ++i) msd[i] += curve.msd[i] / runs;
  std::size_t peak = 0;
  while (peak + 1 < msd.size() && msd[peak + 1] > msd[peak]) ++peak;
  figure.first_maximum = lags[peak] * kTick;
  for (std::size_t i = msd.size() / 2; i < msd.size(); ++i)
    figure.plateau += msd[i] / static_cast<double>(msd.size() - msd.size() / 2);
  return figure;
}

TEST(PumpPower, MorePowerOscillatesFasterOnALowerPlateau) {
  const Figure low = measure(50, -0.08), middle = measure(69, -0.08), high = measure(90, -0.08);
  EXPECT_LT(middle.first_maximum, low.first_maximum);
  EXPECT_LT(high.first_maximum, middle.first_maximum);
  EXPECT_LT(middle.plateau, 0.8 * low.plateau);
  EXPECT_LT(high.plateau, 0.8 * middle.plateau);
}

TEST(PumpPower, LowerWaterActsLikeMorePower) {
  const Figure deep = measure(69, -0.07), shallow = measure(69, -0.09);
  EXPECT_LT(shallow.first_maximum, deep.first_maximum);
  EXPECT_LT(shallow.plateau, 0.8 * deep.plateau);
}

}  // namespace
}  // namespace lilytank
