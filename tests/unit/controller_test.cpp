#include "control/controller.hpp"

#include <gtest/gtest.h>

#include "lilytank/random.hpp"
#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::testing::quiet_model;
using lilytank::testing::Rig;
using lilytank::testing::rules_of;
using lilytank::testing::ruleset_file;
using lilytank::testing::shipped_rulesets;
using lilytank::testing::with_p;

namespace {

Ruleset chain() {
  return read_ruleset(ruleset_file("chain5"));
}

/// A model whose bonds are evaluated in every tick: short tests.
Model hasty(int modules, std::vector<Ruleset> rulesets) {
  Model model = quiet_model(modules, std::move(rulesets));
  model.control.clock = Clock::events;
  model.control.evaluation_rate = 40;
  return model;
}

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
  EXPECT_NEAR(rig.bodies.x[1] - rig.bodies.x[0], rig.model.module.side, 1e-12);
  EXPECT_NEAR(rig.bodies.x[0], 0.002, 1e-12);
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

TEST(Exchange, EveryShippedRulesetBuildsItsTargetAndUndoesItStepByStep) {
  for (const std::string& name : shipped_rulesets()) {
    for (const Clock clock : {Clock::firmware, Clock::events}) {
      const Ruleset read = read_ruleset(ruleset_file(name));
      const Ruleset grow = with_p(read, RuleKind::unlink, 0);
      const Ruleset undo = with_p(with_p(read, RuleKind::link, 0), RuleKind::unlink, 1);
      const int n = static_cast<int>(read.target.size());
      Model model = quiet_model(n, {grow, undo});
      model.control.clock = clock;
      Rig rig(std::move(model), 7);
      rig.place(0, 0, 0, 0.3);
      std::vector<State> before;
      for (int k = 1; k < n; ++k) {
        before.push_back(rig.state);
        rig.offer(k, read.rules[k - 1].before[0], (3 * k + 1) & 3);
        ASSERT_TRUE(rig.until(EventKind::link)) << name << " " << k;
        EXPECT_EQ(rig.events.back().rule, k - 1);
        // Contacts beside the new bond find no rule.
        rig.run(400);
        EXPECT_EQ(rig.cells(0).size(), static_cast<std::size_t>(k + 1));
      }
      EXPECT_EQ(rig.count(EventKind::link), n - 1);
      EXPECT_EQ(canonical_shape(rig.cells(0)), canonical_shape(read.target)) << name;
      rig.state.ruleset = 1;
      for (int k = n - 1; k >= 1; --k) {
        ASSERT_TRUE(rig.until(EventKind::unlink)) << name << " " << k;
        EXPECT_EQ(rig.events.back().rule, n - 1 + k - 1);
        const State& old = before[static_cast<std::size_t>(k - 1)];
        for (int i = 0; i < n; ++i) {
          EXPECT_EQ(rig.state.firmware[i].label, old.firmware[i].label) << name << " " << k;
          EXPECT_EQ(rig.state.firmware[i].last, old.firmware[i].last) << name << " " << k;
          EXPECT_EQ(rig.state.assembly[i], old.assembly[i]) << name << " " << k;
          EXPECT_EQ(rig.state.cell_x[i], old.cell_x[i]) << name << " " << k;
          EXPECT_EQ(rig.state.cell_y[i], old.cell_y[i]) << name << " " << k;
          EXPECT_EQ(rig.state.turn[i], old.turn[i]) << name << " " << k;
        }
      }
    }
  }
}

TEST(Exchange, LAndJAreMirrorImages) {
  std::vector<Cell> shapes[2];
  for (int k = 0; k < 2; ++k) {
    const Ruleset rules =
        with_p(read_ruleset(ruleset_file(k == 0 ? "l4" : "j4")), RuleKind::unlink, 0);
    Rig rig(hasty(4, {rules}), 3);
    rig.place(0, 0, 0);
    for (int i = 1; i < 4; ++i) {
      rig.offer(i, rules.rules[i - 1].before[0], i & 3);
      ASSERT_TRUE(rig.until(EventKind::link));
    }
    shapes[k] = rig.cells(0);
  }
  EXPECT_NE(canonical_shape(shapes[0]), canonical_shape(shapes[1]));
  for (Cell& cell : shapes[1]) cell.x = -cell.x;
  EXPECT_EQ(canonical_shape(shapes[0]), canonical_shape(shapes[1]));
}

TEST(Exchange, SeedRuleGivesItsFirstLabelToTheInitiator) {
  // Both sides initiate: over many seeds module 0 gets label 1 about as often as label 2.
  int first = 0;
  const int runs = 400;
  for (int seed = 1; seed <= runs; ++seed) {
    Rig rig(2, {chain()}, static_cast<std::uint64_t>(seed));
    rig.place(0, 0, 0);
    rig.place_at(1, 2, 0, 0);
    ASSERT_TRUE(rig.until(EventKind::link));
    EXPECT_EQ(rig.state.firmware[0].label + rig.state.firmware[1].label, 3);
    first += rig.state.firmware[0].label == 1 ? 1 : 0;
  }
  EXPECT_NEAR(first, runs / 2, 3 * std::sqrt(runs / 4.0));
}

TEST(Exchange, SharedLeftSidesAreDrawnByTheirProbabilities) {
  const Ruleset rules =
      rules_of("(0,0) (0,0) -> (1,1)-(2,1) p=0.7\n(0,0) (0,0) -> (3,1)-(4,1) p=0.3\n");
  int second = 0;
  const int runs = 1000;
  for (int seed = 1; seed <= runs; ++seed) {
    Rig rig(hasty(2, {rules}), static_cast<std::uint64_t>(seed));
    rig.place(0, 0, 0);
    rig.place_at(1, 2, 0, 0);
    ASSERT_TRUE(rig.until(EventKind::link));
    second += rig.events.back().rule;
  }
  EXPECT_NEAR(second, 0.3 * runs, 3 * std::sqrt(0.3 * 0.7 * runs));
}

TEST(Exchange, ANewContactWithoutARuleLetsGoAndStaysOffWhileTheNeighbourIsThere) {
  const Ruleset none = rules_of("(7,1) (0,0) -> (1,1)-(2,1)\n");
  Rig rig(2, {none});
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  ASSERT_TRUE(rig.until(EventKind::unlatch));
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::off);
  EXPECT_EQ(rig.face(1, 2).status, FaceStatus::off);
  EXPECT_EQ(rig.face(0, 0).partner, -1);
  EXPECT_EQ(rig.state.assembly[1], 1);
  rig.run(4000);
  EXPECT_EQ(rig.log.size(), 2u);
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::off);
  rig.place(1, 1, 1);
  rig.run(100);  // by now the hazard per tick is 1
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::enabled);
  EXPECT_EQ(rig.face(1, 2).status, FaceStatus::enabled);
}

TEST(Exchange, AnUnluckyLinkStaysLatchedAndIsTriedAgain) {
  Rig rig(hasty(2, {rules_of("(0,0) (0,0) -> (1,1)-(2,1) p=0.001\n")}), 1);
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  rig.run(20);
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::latched);
  EXPECT_GE(rig.tallies.evaluations, 19);
  EXPECT_EQ(rig.log.size(), 1u);
  EXPECT_TRUE(rig.until(EventKind::link, 20000));
}

TEST(Exchange, AStandingBondWithoutARuleStays) {
  Rig rig(2, {chain(), rules_of("(7,1) (0,0) -> (1,1)-(2,1)\n")});
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  ASSERT_TRUE(rig.until(EventKind::link));
  rig.state.ruleset = 1;
  const auto before = rig.tallies.evaluations;
  rig.run(4000);
  EXPECT_GT(rig.tallies.evaluations, before + 30);
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::bonded);
}

TEST(Exchange, UpdateRulesChangeLabelsOnAStandingBond) {
  Rig rig(hasty(2, {rules_of("(0,0) (0,0) -> (1,1)-(2,1)\n(1,1)-(2,1) -> (3,1)-(4,2)\n")}), 1);
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  ASSERT_TRUE(rig.until(EventKind::update));
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::bonded);
  const int four = rig.state.firmware[0].label == 4 ? 0 : 1;
  EXPECT_EQ(rig.firmware(four), four == 0 ? "4@1" : "4@3");
  EXPECT_EQ(rig.firmware(1 - four), four == 0 ? "3@2" : "3@0");
}

TEST(Loop, TheFourthContactOfASquareStaysOffAndACutFreesTheLeaf) {
  const Ruleset read = read_ruleset(ruleset_file("o4"));
  const Ruleset grow = with_p(read, RuleKind::unlink, 0);
  Ruleset cut = with_p(grow, RuleKind::link, 0);
  cut.rules.back().p = 1;
  Rig rig(4, {grow, cut});
  rig.place(0, 0, 0);
  for (int i = 1; i < 4; ++i) {
    rig.offer(i, grow.rules[i - 1].before[0], i);
    ASSERT_TRUE(rig.until(EventKind::link));
  }
  rig.run(4000);
  EXPECT_EQ(rig.count(EventKind::latch), 4);
  EXPECT_EQ(rig.count(EventKind::link), 3);
  EXPECT_EQ(rig.count(EventKind::unlatch), 1);
  int bonded = 0, off = 0;
  for (const Face& face : rig.state.faces) {
    bonded += face.status == FaceStatus::bonded ? 1 : 0;
    off += face.status == FaceStatus::off ? 1 : 0;
  }
  EXPECT_EQ(bonded, 6);
  EXPECT_EQ(off, 2);
  EXPECT_EQ(rig.cells(0).size(), 4u);
  rig.state.ruleset = 1;
  ASSERT_TRUE(rig.until(EventKind::unlink));
  EXPECT_EQ(rig.state.assembly[3], 3);  // free, though it still touches two modules
  EXPECT_EQ(rig.state.firmware[3].label, 0);
  rig.run(2000);
  EXPECT_EQ(rig.count(EventKind::latch), 4);
}

TEST(Commands, PausedModulesKeepTheirLatchesAndDoNothing) {
  Model model = quiet_model(3, {chain()});
  model.commands = {{1.0, CommandKind::pause, {}, 0}, {101.0, CommandKind::resume, {}, 0}};
  Rig rig(std::move(model), 1);
  rig.run(39);
  EXPECT_TRUE(rig.log.empty());
  rig.run(2);  // the command's tick is number 40
  ASSERT_EQ(rig.log.size(), 1u);
  EXPECT_EQ(rig.log[0].kind, EventKind::command);
  EXPECT_EQ(rig.log[0].step, 40);
  EXPECT_EQ(rig.log[0].a, 0);
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  rig.face(2, 1).status = FaceStatus::off;
  rig.run(3990);
  EXPECT_EQ(rig.log.size(), 1u);
  EXPECT_EQ(rig.face(2, 1).off_ticks, 0);
  rig.run(20);
  EXPECT_EQ(rig.count(EventKind::latch), 1);
  EXPECT_TRUE(rig.until(EventKind::link));
}

TEST(Commands, APausedNeighbourDoesNotAnswer) {
  for (const Clock clock : {Clock::firmware, Clock::events}) {
    Model model = quiet_model(2, {chain()});
    model.control.clock = clock;
    model.commands = {{0.05, CommandKind::pause, {1}, 0}, {50, CommandKind::resume, {1}, 0}};
    Rig rig(std::move(model), 1);
    rig.place(0, 0, 0);
    rig.place_at(1, 2, 0, 0);
    rig.run(1990);
    EXPECT_EQ(rig.tallies.evaluations, 0);
    EXPECT_EQ(rig.face(0, 0).status, FaceStatus::latched);
    EXPECT_TRUE(rig.until(EventKind::link));
  }
}

TEST(Commands, SwitchedOffIsForEver) {
  Model model = quiet_model(2, {chain()});
  model.commands = {{0, CommandKind::switch_off, {1}, 0},
                    {1, CommandKind::resume, {}, 0},
                    {2, CommandKind::query, {}, 0}};
  Rig rig(std::move(model), 1);
  rig.tick();
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  rig.run(400);
  EXPECT_EQ(rig.count(EventKind::latch), 0);
  EXPECT_EQ(rig.state.firmware[1].power, Power::off);
  EXPECT_EQ(rig.count(EventKind::report), 1);  // only the other answers
}

TEST(Commands, QueryReportsEveryModulesState) {
  Model model = quiet_model(3, {chain()});
  model.commands = {{100, CommandKind::query, {}, 0}, {100, CommandKind::query, {2}, 0}};
  Rig rig(std::move(model), 1);
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  ASSERT_TRUE(rig.until(EventKind::link));
  ASSERT_TRUE(rig.until(EventKind::report));
  ASSERT_EQ(rig.events.size(), 6u);
  EXPECT_EQ(rig.events[0].kind, EventKind::command);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(rig.events[1 + i].a, i);
    EXPECT_EQ(rig.events[1 + i].b, -1);
    EXPECT_EQ(rig.events[1 + i].label_a, rig.state.firmware[i].label);
    EXPECT_EQ(rig.events[1 + i].last_a, rig.state.firmware[i].last);
  }
  EXPECT_EQ(rig.events[4].a, 1);  // the second command
  EXPECT_EQ(rig.events[5].a, 2);
}

TEST(Commands, ANewRulesetKeepsLabelsAndBonds) {
  Model model =
      quiet_model(2, {with_p(chain(), RuleKind::unlink, 0), with_p(chain(), RuleKind::unlink, 1)});
  model.commands = {{100, CommandKind::replace_ruleset, {}, 1}};
  Rig rig(std::move(model), 1);
  rig.place(0, 0, 0);
  rig.place_at(1, 2, 0, 0);
  ASSERT_TRUE(rig.until(EventKind::link));
  const std::string label = rig.firmware(0);
  ASSERT_TRUE(rig.until(EventKind::command));
  EXPECT_EQ(rig.state.ruleset, 1);
  EXPECT_EQ(rig.firmware(0), label);
  EXPECT_EQ(rig.face(0, 0).status, FaceStatus::bonded);
  ASSERT_TRUE(rig.until(EventKind::unlink));
  EXPECT_EQ(rig.firmware(0), "0@-1");
}

TEST(Commands, TimesThatAreNotWholeTicksInBinaryFallOnTheirTick) {
  for (int tick = 0; tick < 2000; ++tick) {
    Model model = quiet_model(1, {});
    model.commands = {{tick / 40.0, CommandKind::query, {}, 0},
                      {std::stod(std::to_string(tick * 0.025)), CommandKind::query, {}, 0}};
    Rig rig(std::move(model), 1);
    rig.state.step = tick - 1;
    if (tick > 0) rig.tick();
    EXPECT_TRUE(rig.log.empty()) << tick;
    rig.state.step = tick;
    rig.tick();
    EXPECT_EQ(rig.log.size(), 4u) << tick;
  }
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

TEST(Controller, StepsWithinATickDoNotCount) {
  Model fine = quiet_model(2, {chain()});
  fine.steps_per_tick = 5, fine.dt = kTick / 5;
  Rig a(2, {chain()}), b(std::move(fine), 1);
  for (Rig* rig : {&a, &b}) {
    rig->place(0, 0, 0);
    rig->place_at(1, 2, 0, 0);
    rig->run(500);
  }
  ASSERT_EQ(a.log.size(), b.log.size());
  for (std::size_t k = 0; k < a.log.size(); ++k) {
    EXPECT_EQ(a.log[k].kind, b.log[k].kind);
    EXPECT_EQ(5 * a.log[k].step, b.log[k].step);
  }
}

}  // namespace
