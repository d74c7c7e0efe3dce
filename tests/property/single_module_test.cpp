// One module alone in a measured flow field: speeds, orbit and displacement against figures that an
// independent program computed for the same physics (5 ms steps, gusts held for 25 ms). The field
// is not part of the project; the test is skipped where it is absent.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "lilytank/random.hpp"
#include "lilytank/study.hpp"
#include "support/msd.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

struct Statistics {
  double speed = 0, rms_speed = 0, radius = 0, rms_spin = 0;
  std::vector<double> msd;
  double radius_between_runs = 0;
};

const std::vector<int> kLags = {1, 2, 3, 4, 5, 6, 8, 10};

std::string measured_field() {
  return std::string(LILYTANK_SOURCE_DIR) + "/../shared/recordings/tank_flow/flow_23.csv";
}

// Mean over runs of 200 s, the first 20 s discarded, starts uniform within 0.2 m.
Statistics observe(double draught, int runs, int steps_per_tick) {
  Model model = test::with_step(standard_model(), steps_per_tick);
  model.module.count = 1;
  model.module.draught = draught;
  model.control.latches = false;
  model.field =
      std::make_shared<const FlowField>(read_flow_csv(measured_field(), Interpolation::bilinear));
  std::vector<Statistics> each(runs);
  for_each_world(runs, 0, [&](int run) {
    World world(model, derived_seed(2026, run));
    test::advance(world, 20);
    Statistics& s = each[run];
    Trajectory track;
    const int steps = 7200;
    for (int i = 0; i < steps; ++i) {
      for (int k = 0; k < steps_per_tick; ++k) world.step();
      append_poses(world, track);
      const Kinematics& k = world.kinematics();
      const double v2 = k.vx[0] * k.vx[0] + k.vy[0] * k.vy[0];
      s.speed += std::sqrt(v2) / steps, s.rms_speed += v2 / steps;
      s.radius += std::hypot(k.x[0], k.y[0]) / steps, s.rms_spin += k.omega[0] * k.omega[0] / steps;
    }
    std::vector<int> lags;
    for (const int second : kLags) lags.push_back(second * 40);
    s.msd = mean_squared_displacement(as_recording(track, BodyKind::lily), lags, Origins::all).msd;
  });
  Statistics mean;
  mean.msd.assign(kLags.size(), 0);
  double square = 0;
  for (const Statistics& s : each) {
    mean.speed += s.speed / runs, mean.rms_speed += s.rms_speed / runs;
    mean.radius += s.radius / runs, mean.rms_spin += s.rms_spin / runs;
    square += s.radius * s.radius / runs;
    for (std::size_t i = 0; i < s.msd.size(); ++i) mean.msd[i] += s.msd[i] / runs;
  }
  mean.rms_speed = std::sqrt(mean.rms_speed), mean.rms_spin = std::sqrt(mean.rms_spin);
  mean.radius_between_runs = std::sqrt(std::fmax(0, square - mean.radius * mean.radius));
  return mean;
}

void print(const char* name, const Statistics& s) {
  std::printf(
      "%s: speed %.4f m/s, rms %.4f, radius %.4f m (between runs %.4f), spin %.3f rad/s, MSD", name,
      s.speed, s.rms_speed, s.radius, s.radius_between_runs, s.rms_spin);
  for (const double m : s.msd) std::printf(" %.4f", m);
  std::printf(" m^2\n");
}

// A steady outer orbit: a tight test, 3 % on speeds and radius, 6 % on the MSD; where the MSD is
// within a fifth of its greatest value of zero, 6 % of that greatest value.
TEST(SingleModule, OuterOrbitOfAShallowModule) {
  if (!std::filesystem::exists(measured_field()))
    GTEST_SKIP() << "the measured flow field is not here";
  const Statistics s = observe(0.025, 60, 5);
  print("draught 25 mm", s);
  EXPECT_NEAR(s.speed, 0.225, 0.03 * 0.225);
  EXPECT_NEAR(s.rms_speed, 0.229, 0.03 * 0.229);
  EXPECT_NEAR(s.radius, 0.179, 0.03 * 0.179);
  EXPECT_NEAR(s.rms_spin, 1.61, 0.06 * 1.61);
  const std::vector<double> want = {0.0439, 0.1111, 0.1102, 0.0462, 0.0085, 0.0475, 0.103, 0.0164};
  for (std::size_t i = 0; i < want.size(); ++i)
    EXPECT_NEAR(s.msd[i], want[i], 0.06 * std::fmax(want[i], 0.2 * 0.1111)) << kLags[i] << " s";
}

// The module switches slowly between two orbits, so runs differ: bounds are four standard errors of
// the difference of two means of 60 runs, with the spread between runs that was published.
TEST(SingleModule, TwoOrbitsOfADeepModule) {
  if (!std::filesystem::exists(measured_field()))
    GTEST_SKIP() << "the measured flow field is not here";
  const Statistics s = observe(0.035, 60, 5);
  print("draught 35 mm", s);
  const double error = 0.048 * std::sqrt(2.0 / 60);
  EXPECT_NEAR(s.radius, 0.103, 4 * error);
  EXPECT_NEAR(s.radius_between_runs, 0.048, 0.02);
  // Speed and spin follow the orbit: about 1.6 (m/s)/m and 15 (rad/s)/m between the two orbits.
  EXPECT_NEAR(s.speed, 0.164, 4 * 1.6 * error);
  EXPECT_NEAR(s.rms_speed, 0.197, 4 * 1.6 * error);
  EXPECT_NEAR(s.rms_spin, 2.87, 4 * 16 * error);
}

}  // namespace
}  // namespace lilytank
