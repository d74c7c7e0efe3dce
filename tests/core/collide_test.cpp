#include "support/reference/collide.hpp"

#include <gtest/gtest.h>

#include "lilytank/random.hpp"
#include "physics/neighbours.hpp"
#include "physics/small_turn.hpp"
#include "support/bodies.hpp"

namespace lilytank::test {
namespace {

using namespace reference;

constexpr double kHalf = 0.0175;

Square square(double x, double y, double angle = 0, unsigned inner = 0) {
  return {x, y, rotation(angle), kHalf, static_cast<std::uint8_t>(inner)};
}

TEST(Collide, FacesMeetAtTwoPoints) {
  const Manifold m = collide(square(0, 0), square(2 * kHalf + 4e-4, 0.01), 1e-3);
  ASSERT_EQ(m.count, 2);
  EXPECT_NEAR(m.nx, 1, 1e-15);
  EXPECT_NEAR(m.ny, 0, 1e-15);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(m.touch[k].gap, 4e-4, 1e-15);
    EXPECT_NEAR(m.touch[k].x, kHalf + 2e-4, 1e-15);
  }
  EXPECT_NEAR(std::min(m.touch[0].y, m.touch[1].y), 0.01 - kHalf, 1e-15);
  EXPECT_NEAR(std::max(m.touch[0].y, m.touch[1].y), kHalf, 1e-15);
}

TEST(Collide, NothingBeyondTheMargin) {
  EXPECT_EQ(collide(square(0, 0), square(2 * kHalf + 1.1e-3, 0.01), 1e-3).count, 0);
  EXPECT_EQ(collide(square(0, 0), Disc{kHalf + 0.0161, 0, 0.015}, 1e-3).count, 0);
  EXPECT_EQ(collide(Disc{0, 0, 0.015}, Disc{0.0311, 0, 0.015}, 1e-3).count, 0);
  EXPECT_EQ(collide_wall(square(0, 0), 0.3, 1e-3).count, 0);
  EXPECT_EQ(collide_wall(Disc{0.2, 0, 0.015}, 0.3, 1e-3).count, 0);
}

TEST(Collide, ACornerPointsAtAFace) {
  const double out = kHalf * std::sqrt(2.0);
  const Manifold m = collide(square(0, 0), square(0.004, kHalf + out - 1e-4, kPi / 4), 0);
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(m.nx, 0, 1e-15);
  EXPECT_NEAR(m.ny, 1, 1e-15);
  EXPECT_NEAR(m.touch[0].x, 0.004, 1e-12);
  EXPECT_NEAR(m.touch[0].gap, -1e-4, 1e-15);
}

TEST(Collide, TwoCornersAreJoinedByTheirNormal) {
  const Manifold m = collide(square(0, 0), square(2 * kHalf + 3e-4, 2 * kHalf + 4e-4), 1e-3);
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(m.touch[0].gap, 5e-4, 1e-15);
  EXPECT_NEAR(m.nx, 0.6, 1e-12);
  EXPECT_NEAR(m.ny, 0.8, 1e-12);
}

// A row of two modules: a square that overlaps a little with the side of both may not be pushed
// along the row by the seam, however shallow its overlap in that direction.
TEST(Collide, SeamsDoNotCatch) {
  const Square left = square(0, 0, 0, 1u << 0), right = square(2 * kHalf, 0, 0, 1u << 2);
  for (double x = 0.006; x < 0.03; x += 0.0005) {
    for (const double tilt : {0.0, 0.02, -0.02, 0.3, -0.3}) {
      const double low = kHalf * (std::fabs(std::cos(tilt)) + std::fabs(std::sin(tilt)));
      const Square slider = square(x, kHalf + low - 1e-5, tilt);
      int count = 0;
      for (const Square& member : {left, right}) {
        const Manifold m = collide(member, slider, 0);
        count += m.count;
        // Upward, but for the slider's own tilt.
        if (m.count == 0) continue;
        EXPECT_GT(m.ny, std::cos(tilt) - 1e-12) << x << " " << tilt;
      }
      EXPECT_GT(count, 0) << x << " " << tilt;
    }
  }
}

TEST(Collide, DiscMeetsFaceCornerAndSeam) {
  Manifold m = collide(square(0, 0), Disc{0.003, kHalf + 0.0149, 0.015}, 0);
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(m.ny, 1, 1e-15);
  EXPECT_NEAR(m.touch[0].gap, -1e-4, 1e-15);
  m = collide(square(0, 0), Disc{kHalf + 0.009, kHalf + 0.012, 0.015}, 1e-3);
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(m.nx, 0.6, 1e-12);
  EXPECT_NEAR(m.touch[0].gap, 0, 1e-15);
  const Square seam = square(0, 0, 0, 1u << 0);
  EXPECT_EQ(collide(seam, Disc{kHalf + 0.001, kHalf + 0.0149, 0.015}, 0).count, 0);
}

TEST(Collide, OnlyCornersMeetTheWall) {
  const double side = std::sqrt(0.3 * 0.3 - kHalf * kHalf) - kHalf;
  const WallManifold m = collide_wall(square(0, side - 1e-4), 0.3, 1e-3);
  ASSERT_EQ(m.count, 2);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(m.touch[k].gap, 1e-4, 1e-6);
    EXPECT_LT(m.ny[k], -0.99);
    EXPECT_NEAR(m.nx[k] * m.nx[k] + m.ny[k] * m.ny[k], 1, 1e-15);
  }
  EXPECT_NEAR(wall_separation(square(0, side - 1e-4), 0.3), m.touch[0].gap, 1e-15);
}

TEST(SmallTurn, AgreesWithTheGeneralRotation) {
  for (double angle = -0.4; angle < 0.4; angle += 0.0037) {
    const Rot p = small_turn(angle), q = rotation(angle);
    EXPECT_NEAR(p.c, q.c, 4e-16);
    EXPECT_NEAR(p.s, q.s, 2e-16);
  }
}

// What is told of each body, against all pairs, in their order. Pairs that miss the distance by
// less than float32 can tell may be told or not.
void expect_all_pairs(const Neighbours& neighbours, const std::vector<float>& x,
                      const std::vector<float>& y, double distance) {
  const int n = static_cast<int>(x.size());
  for (int i = 0; i < n; ++i) {
    const auto apart = [&](int j) {
      return static_cast<double>(std::hypot(x[j] - x[i], y[j] - y[i]));
    };
    std::vector<int> around, above, all, higher;
    neighbours.around(i, [&](int j) {
      EXPECT_LT(apart(j), distance + 1e-5);
      if (apart(j) < distance) around.push_back(j);
    });
    neighbours.above(i, [&](int j) {
      EXPECT_LT(apart(j), distance + 1e-5);
      if (apart(j) < distance) above.push_back(j);
    });
    for (int j = 0; j < n; ++j) {
      if (j == i || apart(j) >= distance) continue;
      all.push_back(j);
      if (j > i) higher.push_back(j);
    }
    ASSERT_EQ(around, all);
    ASSERT_EQ(above, higher);
  }
}

// Bits for few bodies, lists from a grid for many.
TEST(Neighbours, AreAllBodiesWithinTheDistance) {
  for (const int n : {3, 15, 40, 64, 65, 300}) {
    std::vector<float> x(n), y(n);
    for (int i = 0; i < n; ++i) {
      const auto body = static_cast<std::uint32_t>(i);
      x[i] = static_cast<float>(
          1.1 * (2 * uniform({7, Stream::start_pose, n, body, 0}) - 1));  // some outside
      y[i] = static_cast<float>(1.1 * (2 * uniform({7, Stream::start_pose, n, body, 1}) - 1));
    }
    Neighbours neighbours(n, 1);
    for (const double distance : {0.05, 0.3, 3.0}) {
      neighbours.search(x.data(), y.data(), distance);
      expect_all_pairs(neighbours, x, y, distance);
    }
  }
}

// A list made in an earlier step serves later ones: bodies that wander by millimetres, one that
// jumps, distances that change from step to step.
TEST(Neighbours, OfBodiesThatMoveAreThoseOfTheMoment) {
  constexpr int kBodies = 200;
  std::vector<float> x(kBodies), y(kBodies);
  Neighbours neighbours(kBodies, 0.6);
  for (int step = 0; step < 60; ++step) {
    const double size = step == 0 ? 0.6 : 6e-3;
    for (int i = 0; i < kBodies; ++i) {
      const auto body = static_cast<std::uint32_t>(i);
      x[i] += static_cast<float>(size * (2 * uniform({8, Stream::start_pose, step, body, 0}) - 1));
      y[i] += static_cast<float>(size * (2 * uniform({8, Stream::start_pose, step, body, 1}) - 1));
    }
    if (step % 7 == 6) x[step] = -x[step];
    const double distance = step % 5 == 4 ? 0.09 : 0.06;
    neighbours.search(x.data(), y.data(), distance);
    expect_all_pairs(neighbours, x, y, distance);
    if (HasFatalFailure()) FAIL() << "in step " << step;
  }
}

TEST(Motion, NearPairsAreOfModulesAndOrdered) {
  Bodies b(bare_model(4, 0.3, 1));
  b.make_chain(0, 2, 0, 0);
  b.place(2, 0.035, 0.045), b.place(3, 0.2, 0), b.place(4, 0, 0.04);
  b.derive();
  b.hot.load(b.state, b.assemblies);
  const auto found = b.motion->near_pairs(b.hot, 0.05);
  const std::vector<std::pair<int, int>> pairs(found.begin(), found.end());
  EXPECT_EQ(pairs, (std::vector<std::pair<int, int>>{{0, 1}, {1, 2}}));
}

TEST(Motion, OverlapOfKnownDepthIsMeasured) {
  Bodies b(bare_model(2, 0.3, 1));
  b.place(0, 0, 0), b.place(1, 0.0349, 0.01), b.place(2, 0.2, 0);
  b.derive();
  EXPECT_NEAR(b.overlap(), 1e-4, 1e-15);
  b.place(1, 0, 0.1), b.place(2, kHalf + 0.015 - 3e-4, 0);
  b.derive();
  EXPECT_NEAR(b.overlap(), 3e-4, 1e-15);
  b.place(2, 0.2853, 0);
  b.derive();
  EXPECT_NEAR(b.overlap(), 3e-4, 1e-15);
}

TEST(Motion, SettleMakesRoomWithoutChangingTwists) {
  Bodies b(bare_model(4));
  b.make_chain(0, 2, 0, 0);
  b.place(2, 0.068, 0.003, 0.05), b.place(3, 0.104, 0.004, 0.1);  // 2 mm into 1; 3 behind 2
  b.set_twist(2, 0.1, 0.2, 0.3);
  b.derive();
  ASSERT_GT(b.overlap(), 1e-3);
  const double centre = b.state.x[0] * 2 + b.state.x[2] + b.state.x[3];
  ASSERT_TRUE(b.settle(0));
  EXPECT_LT(b.overlap(), 0.25e-3);
  EXPECT_EQ(b.state.vx[2], static_cast<double>(0.1f));
  EXPECT_EQ(b.state.omega[2], static_cast<double>(0.3f));
  EXPECT_NEAR(b.state.x[0] * 2 + b.state.x[2] + b.state.x[3], centre, 1e-7);
}

TEST(Motion, SettleLeavesTheStateWhereThereIsNoRoom) {
  Bodies b(bare_model(4, 0.034));  // a tank that two modules side by side do not fit into
  b.place(0, -0.01, 0), b.place(1, 0.01, 0), b.place(2, 0, 0.01), b.place(3, 0, -0.01);
  b.derive();
  const std::uint64_t before = fingerprint(b.state);
  EXPECT_FALSE(b.settle(0));
  EXPECT_EQ(fingerprint(b.state), before);
}

TEST(Motion, FreeFlightIsExact) {
  Bodies b(bare_model(2, 0.3, 1));
  b.place(0, 0.01, 0.02, 1), b.place(1, 0.1, 0.1, 2), b.place(2, -0.1, 0);
  b.set_twist(0, 0.2, -0.1, 3), b.set_twist(1, -0.1, 0, -5), b.set_twist(2, 0.1, 0.1, 7);
  b.derive();
  b.step(4);
  EXPECT_NEAR(b.state.x[0], 0.01 + 0.02, 1e-8);
  EXPECT_NEAR(b.state.y[0], 0.02 - 0.01, 1e-8);
  EXPECT_NEAR(angle_of({b.state.c[1], b.state.s[1]}), 2 - 0.5, 1e-6);
  EXPECT_EQ(b.state.omega[2], 0);  // balls do not turn
  EXPECT_EQ(b.state.c[2], 1);
}

TEST(Motion, ABrokenStateIsLeftAlone) {
  Bodies b(bare_model(2));
  b.place(1, 0.1, 0);
  b.set_twist(0, std::nan(""), 0, 0);
  b.derive();
  b.step();
  EXPECT_EQ(b.state.x[1], static_cast<double>(0.1f));
  b.set_twist(0, 1e5, 0, 0);
  b.step();
  EXPECT_EQ(b.state.x[0], 0);
}

}  // namespace
}  // namespace lilytank::test
