// Latches: what holds what, and when a face that is off comes back.
#include <gtest/gtest.h>

#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::chain;
using lilytank::test::quiet_model;
using lilytank::test::Rig;

namespace {

TEST(Docking, FacesThatMeetHoldEachOtherAtOnce) {
  Rig rig(2, {chain()});
  rig.place(0, 0, 0);
  rig.place_at(1, 3, 0, 0, 0.004);
  rig.tick();
  ASSERT_EQ(rig.events.size(), 1u);
  const Event& e = rig.events[0];
  EXPECT_EQ(e.kind, EventKind::latch);
  EXPECT_EQ(e.a, 0);
  EXPECT_EQ(e.b, 1);
  EXPECT_EQ(e.face_a, 0);
  EXPECT_EQ(e.face_b, 3);
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::latched);
  EXPECT_EQ(rig.face(0, 0).partner, 1);
  EXPECT_EQ(rig.face(1, 3).partner_face, 0);
  EXPECT_EQ(rig.state.assembly[1], 0);
  // Both moved half of the gap, onto one lattice.
  EXPECT_NEAR(rig.bodies.x[1] - rig.bodies.x[0], rig.model.module.side, 1e-8);
  EXPECT_NEAR(rig.bodies.x[0], 0.002, 1e-8);
}

TEST(Docking, ReachEndsAtTheCaptureDistanceAndAngle) {
  const auto latches = [](double gap, double sideways, double angle) {
    Rig rig(2, {chain()});
    rig.place(0, 0, 0);
    // Turned about its face's centre, so that gap and angle are independent.
    const double half = rig.model.module.side / 2;
    const Rot r = rotation(angle);
    rig.place(1, half + gap + half * r.c, sideways + half * r.s, angle);
    rig.tick();
    return rig.count(EventKind::latch) == 1;
  };
  EXPECT_TRUE(latches(0.0049, 0, 0));
  EXPECT_FALSE(latches(0.0051, 0, 0));
  EXPECT_TRUE(latches(0.003, 0.0039, 0));
  EXPECT_FALSE(latches(0.003, 0.0041, 0));
  EXPECT_TRUE(latches(0.004, 0, 0.19));
  EXPECT_TRUE(latches(0.004, 0, -0.19));
  EXPECT_FALSE(latches(0.004, 0, 0.21));
}

TEST(Docking, TheNearestFaceWins) {
  Rig rig(3, {});
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0, 0.004);
  rig.place_at(2, 2, 0, 2, 0.001);
  rig.tick();
  ASSERT_FALSE(rig.events.empty());
  EXPECT_EQ(rig.events[0].b, 2);
}

TEST(Docking, NothingLatchesWithLatchesOff) {
  Model model = quiet_model(2, {chain()});
  model.control.latches = false;
  Rig rig(std::move(model), 1);
  rig.place(0, 0, 0);
  rig.place_at(1, 0, 0, 0);
  rig.run(100);
  EXPECT_TRUE(rig.log.empty());
}

TEST(Docking, WithoutARulesetALatchStaysForEver) {
  Rig rig(2, {});
  rig.place(0, 0, 0);
  rig.place_at(1, 0, 0, 0);
  rig.run(2000);
  EXPECT_EQ(rig.log.size(), 1u);
  EXPECT_EQ(rig.face(1, 0).status, FaceStatus::latched);
  EXPECT_EQ(rig.tallies.evaluations, 0);
}

// Module 2 comes to face 1 of module 0 with a companion, 3, that would have to lie on the cell of
// module 1. (The companion is held at a corner: no latch does that, but nothing else is so short.)
TEST(Docking, ALatchWithoutRoomIsRefusedAndChangesNothing) {
  Rig rig(4, {});
  const double side = rig.model.module.side;
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  rig.tick();
  ASSERT_EQ(rig.count(EventKind::latch), 1);
  State& s = rig.state;
  s.assembly[3] = 2, s.cell_x[3] = 1, s.cell_y[3] = -1;
  s.x[2] = rig.bodies.x[0] + side / 2, s.y[2] = rig.bodies.y[0] + side / 2 + 0.002;
  s.vx[2] = 0.1;
  derive(rig.model, s, rig.bodies);
  rig.round();
  const State before = s;
  rig.tick();
  EXPECT_EQ(rig.tallies.snaps_refused, 1);
  EXPECT_EQ(rig.count(EventKind::latch), 1);
  EXPECT_EQ(s.x, before.x);
  EXPECT_EQ(s.y, before.y);
  EXPECT_EQ(s.vx, before.vx);
  EXPECT_EQ(s.assembly, before.assembly);
  EXPECT_EQ(s.cell_x, before.cell_x);
  EXPECT_EQ(s.turn, before.turn);
  EXPECT_EQ(rig.face(0, 1).status, FaceStatus::enabled);
  EXPECT_EQ(rig.face(2, 3).partner, -1);
  // Both faces rest, then try again: in every fifth tick.
  rig.run(5 * (Docking::kRetryTicks + 1));
  EXPECT_EQ(rig.tallies.snaps_refused, 6);
}

// The authors' firmware: a face that was released comes on after 0.49 s on average if nothing is
// near. With hazard c / 256 in the c-th tick the mean number of ticks is sum of prod (1 - c/256).
TEST(OffTime, MeanIsHalfASecond) {
  const int modules = 400;
  Rig rig(quiet_model(modules, {chain()}), 5);
  for (Face& face : rig.state.faces) face.status = FaceStatus::off;
  derive(rig.model, rig.state, rig.bodies);
  double mean = 0, square = 0, survive = 1;
  for (int c = 1; c <= 256; ++c) {
    const double here = survive * c / 256;
    mean += here * c, square += here * c * c;
    survive -= here;
  }
  EXPECT_NEAR(mean * kTick, 0.49, 0.005);
  double total = 0;
  for (int t = 1; t <= 256; ++t) {
    const auto off = [&] {
      int n = 0;
      for (const Face& face : rig.state.faces) n += face.status == FaceStatus::off ? 1 : 0;
      return n;
    };
    total += off();
    rig.tick();
  }
  const double faces = 4.0 * modules;
  EXPECT_NEAR(total / faces, mean, 3 * std::sqrt((square - mean * mean) / faces));
}

}  // namespace
