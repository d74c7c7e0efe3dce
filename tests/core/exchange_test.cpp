// Exchanges between latched modules: rules, their probabilities and what they leave.
#include <gtest/gtest.h>

#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::chain;
using lilytank::test::hasty;
using lilytank::test::quiet_model;
using lilytank::test::Rig;
using lilytank::test::rules_of;
using lilytank::test::ruleset_file;
using lilytank::test::shipped_rulesets;
using lilytank::test::with_p;

namespace {

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

}  // namespace
