// The guarantee of the contact solver: whatever the density, the kicks and the speed, no overlap
// exceeds kOverlapLimit, nothing leaves the tank, and nothing gets through anything.
#include <gtest/gtest.h>

#include "lilytank/random.hpp"
#include "physics/island_block.hpp"
#include "support/bodies.hpp"

namespace lilytank::test {
namespace {

// Builds without optimisation, or with sanitizers, are too slow for the full numbers of steps.
#ifdef NDEBUG
constexpr int kLess = 1;
#else
constexpr int kLess = 20;
#endif

constexpr double kRounding = 1e-5;  // share of an energy that float32 may add
constexpr double kNear = 1e-6;      // m, likewise of an overlap

// Points of a square lattice whose modules fit into the tank, row by row.
std::vector<Vec2> lattice(double tank, double pitch) {
  constexpr double half = 0.0175;
  std::vector<Vec2> points;
  const int most = static_cast<int>(tank / pitch) + 1;
  for (int row = -most; row <= most; ++row) {
    for (int column = -most; column <= most; ++column) {
      const Vec2 p((column + 0.5) * pitch, (row + 0.5) * pitch);
      if ((p.cwiseAbs() + Vec2(half, half)).norm() < tank) points.push_back(p);
    }
  }
  return points;
}

void lay(Bodies& b, const std::vector<Vec2>& points) {
  for (int i = 0; i < b.model.bodies(); ++i) b.place(i, points[i].x(), points[i].y());
  b.derive();
}

struct Shaking {
  double kick = 0;     // m/s, deviation of each component per step
  double spin = 0;     // rad/s
  double push = 0;     // m/s per step, common to all, along a direction that turns slowly
  double keep = 0.99;  // share of the velocity left by damping
};

void shake(Bodies& b, const Shaking& s, std::int64_t step) {
  const Rot way = rotation(0.002 * static_cast<double>(step % 100000));
  for (const int slot : b.assemblies.live) {
    const auto id = static_cast<std::uint32_t>(slot);
    const auto g = normal_pair({31, Stream::stochastic, step, id, 0});
    const auto w = normal_pair({31, Stream::stochastic, step, id, 1});
    b.state.vx[slot] = s.keep * b.state.vx[slot] + s.kick * g[0] + s.push * way.c;
    b.state.vy[slot] = s.keep * b.state.vy[slot] + s.kick * g[1] + s.push * way.s;
    b.state.omega[slot] = s.keep * b.state.omega[slot] + s.spin * w[0];
  }
}

// Runs and checks after every step; returns the deepest overlap.
double endure(Bodies& b, const Shaking& s, int steps) {
  double deepest = 0;
  for (int step = 0; step < steps; ++step) {
    shake(b, s, step);
    const double energy = b.energy();
    b.step();
    const double now = b.overlap();
    deepest = std::max(deepest, now);
    // Pairs that overlap by less than the slop need not be solved, nor counted.
    if (now > std::max<double>(b.tallies.deepest_overlap, kSlop) + kNear) {
      ADD_FAILURE() << "step " << step << ", overlap " << now << " m, reported "
                    << b.tallies.deepest_overlap;
      return deepest;
    }
    if (deepest > kOverlapLimit || !(b.energy() <= energy * (1 + kRounding))) {
      ADD_FAILURE() << "step " << step << ", overlap " << deepest << " m, energy " << energy
                    << " to " << b.energy() << " J";
      return deepest;
    }
  }
  return deepest;
}

void report(const Bodies& b, double deepest) {
  testing::Test::RecordProperty("deepest_um", static_cast<int>(1e6 * deepest));
  testing::Test::RecordProperty("moves_undone", static_cast<int>(b.tallies.moves_undone));
}

void small_tank(int steps) {
  Bodies b(bare_model(12, 0.09));
  lay(b, lattice(0.09, 0.036));
  const double deepest = endure(b, {0.01, 0.3, 0.005}, steps);
  report(b, deepest);
  EXPECT_LT(deepest, kOverlapLimit);
}

TEST(PackedTank, AHundredThousandStepsOfASmallTank) {
  small_tank(100'000 / kLess);
}

TEST(LongPackedTank, AMillionStepsOfASmallTank) {
  small_tank(1'000'000 / kLess);
}

TEST(PackedTank, StrongKicksOfASmallTank) {
  Bodies b(bare_model(12, 0.09));
  lay(b, lattice(0.09, 0.036));
  report(b, endure(b, {0.2, 8, 0.1}, 20000 / kLess));
}

// As many as lie on a lattice with 1 mm between them, kicked at random and pushed to one side,
// which goes round the tank one and a half times in 5000 steps.
void full_tank(int steps) {
  const std::vector<Vec2> points = lattice(0.3, 0.036);
  Bodies b(bare_model(static_cast<int>(points.size())));
  lay(b, points);
  report(b, endure(b, {0.01, 0.3, 0.01}, steps));
}

TEST(PackedTank, AFullTank) {
  full_tank(1000 / kLess);
}

TEST(LongPackedTank, AFullTank) {
  full_tank(5000 / kLess);
}

// A thinner tank, whose pushed heap comes to lie at all angles.
void pushed_heap(int steps) {
  const std::vector<Vec2> points = lattice(0.3, 0.044);
  Bodies b(bare_model(static_cast<int>(points.size())));
  lay(b, points);
  report(b, endure(b, {0.05, 2, 0.03}, steps));
}

TEST(PackedTank, AHeapThatIsPushedAbout) {
  pushed_heap(1500 / kLess);
}

TEST(LongPackedTank, AHeapThatIsPushedAbout) {
  pushed_heap(5000 / kLess);
}

void balls_and_modules(int steps) {
  const std::vector<Vec2> points = lattice(0.15, 0.036);
  const int n = static_cast<int>(points.size());
  Bodies b(bare_model(n / 2, 0.15, n - n / 2));
  lay(b, points);
  report(b, endure(b, {0.05, 2, 0.03}, steps));
}

TEST(PackedTank, BallsAndModulesTogether) {
  balls_and_modules(8000 / kLess);
}

TEST(LongPackedTank, BallsAndModulesTogether) {
  balls_and_modules(20000 / kLess);
}

// A ball cannot spin: contacts can turn it aside and give it exactly its old velocity again.
TEST(PackedTank, BallsInALooseCrowd) {
  const std::vector<Vec2> points = lattice(0.3, 0.042);
  Bodies b(bare_model(0, 0.3, static_cast<int>(points.size())));
  lay(b, points);
  report(b, endure(b, {0.1, 0, 0.02}, 3000 / kLess));
}

TEST(PackedTank, ChainsAmongSingleModules) {
  const std::vector<Vec2> points = lattice(0.15, 0.0365);
  Bodies b(bare_model(static_cast<int>(points.size()), 0.15));
  lay(b, points);
  int joined = 0;
  for (int i = 0; i + 1 < b.model.module.count; ++i) {
    const bool neighbours = std::fabs(points[i].y() - points[i + 1].y()) < 1e-9;
    if (neighbours && i % 4 != 3 && b.bond(i, 0, i + 1, 2)) ++joined;
  }
  ASSERT_GT(joined, 10);
  for (const int slot : std::vector<int>(b.assemblies.live)) ASSERT_TRUE(b.settle(slot));
  report(b, endure(b, {0.05, 2, 0.03}, 10000 / kLess));
}

// Shots at 5 to 15 m/s (up to 0.4 m a step) at a wall of modules that splits the tank in two: what
// was on one side of it stays there.
TEST(FastShots, DoNotGetThroughAChainOrTheWall) {
  for (std::uint32_t k = 0; k < 300; ++k) {
    Bodies b(bare_model(17, 0.3, 1));
    b.make_chain(0, 16, -7.5 * 0.035, 0);
    const auto u = [&](std::uint32_t index) {
      return uniform({41, Stream::start_pose, 0, k, index});
    };
    const double speed = 5 + 10 * u(0);
    const Rot way = rotation(-kPi * (0.1 + 0.8 * u(1))), up = rotation(kPi * (0.1 + 0.8 * u(4)));
    b.place(16, 0.1 * (u(2) - 0.5), 0.15, 6 * u(3));
    b.place(17, 0.1 * (u(2) - 0.5), -0.15);
    b.set_twist(16, speed * way.c, speed * way.s, 100 * (u(5) - 0.5));
    b.set_twist(17, speed * up.c, speed * up.s);
    b.derive();
    for (int step = 0; step < 12; ++step) {
      const double energy = b.energy();
      b.step();
      ASSERT_LE(b.energy(), energy * (1 + kRounding)) << k;
      ASSERT_LE(b.overlap(), kOverlapLimit) << k << " " << step;
      const Rot chain{b.state.c[0], b.state.s[0]};
      const auto side = [&](int i) {
        return unrotate(chain, Vec2(b.state.x[i] - b.state.x[0], b.state.y[i] - b.state.y[0])).y();
      };
      ASSERT_GT(side(16), 0.03) << k << " " << step;
      ASSERT_LT(side(17), -0.03) << k << " " << step;
    }
  }
}

TEST(FastShots, DoNotGetThroughSingleModules) {
  for (std::uint32_t k = 0; k < 500; ++k) {
    Bodies b(bare_model(2, 0.5));
    const double speed = 5 + 10 * uniform({43, Stream::start_pose, 0, k, 0});
    const double offset = 0.02 * (uniform({43, Stream::start_pose, 0, k, 1}) - 0.5);
    b.place(0, -0.4, offset, 6 * uniform({43, Stream::start_pose, 0, k, 2}));
    b.place(1, 0, 0, 6 * uniform({43, Stream::start_pose, 0, k, 3}));
    b.set_twist(0, speed, 0);
    b.derive();
    while (b.state.vx[1] == 0 && b.state.x[0] < 0.1) b.step();
    EXPECT_GT(b.state.vx[1], 0.1 * speed) << k;
    EXPECT_LE(b.overlap(), kOverlapLimit) << k;
  }
}

// A step that would take more work than is allowed ends the motion, not the promise.
TEST(PackedTank, AStepIsGivenUpBeforeItTakesTooMuchWork) {
  Bodies b(bare_model(12, 0.09));
  lay(b, lattice(0.09, 0.036));
  b.motion = std::make_unique<Motion>(b.model, 2000);
  int stalled = -1, step = 0;
  for (; stalled < 0 && step < 2000; ++step) {
    shake(b, {0.05, 2, 0.03}, step);
    const Vec2 before(b.state.x[0], b.state.y[0]);
    stalled = b.advance_once();
    EXPECT_LE(b.overlap(), kOverlapLimit) << step;
    if (stalled >= 0) {
      EXPECT_EQ(before, Vec2(b.state.x[0], b.state.y[0]));
    }
  }
  EXPECT_GT(step, 1);  // easy steps are taken
  ASSERT_GE(stalled, 0);
  EXPECT_LT(stalled, 12);
}

// The state alone decides: a solver that has run before gives the same bits as a new one.
TEST(PackedTank, TheSolverKeepsNothing) {
  Bodies b(bare_model(12, 0.09));
  lay(b, lattice(0.09, 0.036));
  for (int step = 0; step < 300; ++step) {
    shake(b, {0.05, 2, 0.02}, step);
    State copy = b.state;
    Assemblies afresh;
    afresh.resize(b.model);
    derive(b.model, copy, afresh);
    Motion other(b.model);
    lilytank::Bodies hot(b.model);
    hot.load(copy, afresh);
    Tallies tallies;
    InMotion one{&other, &hot, &afresh, &tallies};
    Movers().advance({&one, 1});
    hot.save(copy, afresh);
    b.step();
    ASSERT_EQ(fingerprint(copy), fingerprint(b.state)) << step;
  }
}

}  // namespace
}  // namespace lilytank::test
