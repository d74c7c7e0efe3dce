#include "../../render/poses.hpp"

#include <gtest/gtest.h>

#include "../../render/yield.hpp"
#include "render/sample_run.hpp"

namespace lilytank {
namespace {

Trajectory two_frames() {
  Trajectory t;
  t.bodies = t.modules = 2;
  t.time = {0, 2};
  t.x = {0, 1, 4, 1};
  t.y = {0, 0, -2, 0};
  t.theta = {3.0F, 0.5F, -3.0F, -0.5F};
  t.markings.resize(4);
  t.markings[2].label = 7;
  return t;
}

TEST(Poses, PositionsGoStraightAndAnglesTheShortWay) {
  Snapshot s;
  interpolate(two_frames(), 0.035, 0.5, s);
  EXPECT_NEAR(s.poses[0].x, 1, 1e-6);
  EXPECT_NEAR(s.poses[0].y, -0.5, 1e-6);
  // From 3 to -3 rad it is 0.2832 rad over the back, not 6 over the front.
  EXPECT_NEAR(s.poses[0].theta, 3 + 0.25 * (2 * kPi - 6), 1e-6);
  EXPECT_NEAR(s.poses[1].theta, 0.25, 1e-6);
  EXPECT_EQ(s.marks[0].label, 0) << "markings are those of the frame before";
  interpolate(two_frames(), 0.035, 2, s);
  EXPECT_EQ(s.marks[0].label, 7);
  EXPECT_NEAR(s.poses[0].x, 4, 1e-6);
}

TEST(Poses, ATurningPairStaysAPair) {
  const double side = 0.035;
  Trajectory t;
  t.bodies = t.modules = 2;
  t.time = {0, 1};
  // Turns by 120 degrees about its middle while that moves 0.1 m.
  for (int f = 0; f < 2; ++f) {
    const double a = f * 2 * kPi / 3;
    for (const double along : {-side / 2, side / 2}) {
      t.x.push_back(static_cast<float>(0.1 * f + along * std::cos(a)));
      t.y.push_back(static_cast<float>(along * std::sin(a)));
      t.theta.push_back(static_cast<float>(a));
    }
  }
  t.markings.resize(4);
  t.markings[0].latched = 1, t.markings[1].latched = 4;
  Snapshot s;
  for (const double time : {0.0, 0.25, 0.5, 1.0}) {
    interpolate(t, side, time, s);
    const double dx = s.poses[1].x - s.poses[0].x, dy = s.poses[1].y - s.poses[0].y;
    EXPECT_NEAR(std::hypot(dx, dy), side, 1e-6) << time;
    EXPECT_NEAR(std::atan2(dy, dx), time * 2 * kPi / 3, 1e-5) << time;
    EXPECT_NEAR((s.poses[1].x + s.poses[0].x) / 2, 0.1 * time, 1e-6) << time;
  }
  EXPECT_NEAR(s.poses[0].x, t.x[2], 1e-6);
  // Modules that let go by the next frame move on their own.
  t.x[3] += 0.01F;
  interpolate(t, side, 0.5, s);
  EXPECT_NEAR(s.poses[1].x, (t.x[1] + t.x[3]) / 2, 1e-6);
}

TEST(Poses, TimesOutsideAreRefused) {
  EXPECT_NO_THROW(check_time(two_frames(), 0));
  EXPECT_NO_THROW(check_time(two_frames(), 2));
  EXPECT_THROW(check_time(two_frames(), 2.1), InputError);
  EXPECT_THROW(check_time(Trajectory{}, 0), InputError);
}

TEST(Yield, CountsCopiesFrameByFrame) {
  const YieldCurve curve = yield_of(sample::run(600));
  EXPECT_EQ(curve.possible, 3);
  EXPECT_EQ(curve.target_size, 5);
  EXPECT_EQ(curve.at(0), 0);
  EXPECT_EQ(curve.at(sample::join_time(0, 4)), 0) << "the last bond is still to come";
  EXPECT_EQ(curve.at(sample::join_time(0, 4) + 2), 1);
  EXPECT_EQ(curve.at(sample::join_time(1, 4) + 2), 2);
  EXPECT_EQ(curve.time.size(), 4u) << "only changes are kept";
}

TEST(Yield, TicksIncludeTheTop) {
  using Numbers = std::vector<int>;
  EXPECT_EQ(copy_ticks(1), (Numbers{0, 1}));
  EXPECT_EQ(copy_ticks(3), (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(copy_ticks(6), (Numbers{0, 2, 4, 6}));
  EXPECT_EQ(copy_ticks(7), (Numbers{0, 2, 4, 7}));
  EXPECT_EQ(copy_ticks(12), (Numbers{0, 3, 6, 9, 12}));
  for (int most = 1; most < 500; ++most) {
    const Numbers ticks = copy_ticks(most);
    EXPECT_EQ(ticks.front(), 0);
    EXPECT_EQ(ticks.back(), most);
    EXPECT_LE(ticks.size(), 6u) << most;
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      EXPECT_GE(8 * (ticks[i] - ticks[i - 1]), most) << "labels would touch, of " << most;
    }
  }
}

TEST(Clock, ReadsHoursMinutesSeconds) {
  EXPECT_EQ(clock_text(0), "0:00:00");
  EXPECT_EQ(clock_text(59.9), "0:00:59");
  EXPECT_EQ(clock_text(59.9999), "0:01:00") << "rounding of a frame's time";
  EXPECT_EQ(clock_text(3723), "1:02:03");
  EXPECT_EQ(clock_text(360000), "100:00:00");
}

}  // namespace
}  // namespace lilytank
