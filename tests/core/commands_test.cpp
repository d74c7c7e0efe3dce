// What the base station says.
#include <gtest/gtest.h>

#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::chain;
using lilytank::test::hasty;
using lilytank::test::quiet_model;
using lilytank::test::Rig;
using lilytank::test::rules_of;
using lilytank::test::with_p;

namespace {

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

// A pair is the whole target here, so each pair is a copy.
Ruleset pairs(double p_undone) {
  return with_p(rules_of("r1: (0,0) (0,0) -> (1,1)-(2,1) p=1\n"
                         "r1_reverse: (1,1)-(2,1) -> (0,0) (0,0) p=1\n"),
                RuleKind::unlink, p_undone);
}

TEST(Commands, RulesetAndPumpsFollowTheNumberOfFinishedCopies) {
  Model model = hasty(4, {pairs(0), pairs(1)});
  Command replace{.kind = CommandKind::replace_ruleset, .ruleset = 1, .copies = 2};
  Command pumps{.kind = CommandKind::pump_power, .copies = 1, .field = 1};
  model.feedback = {pumps, replace};
  Rig rig(std::move(model), 1);
  rig.place(0, 0, 0), rig.place(2, 0, 1);
  rig.run(10);
  EXPECT_EQ(rig.state.field, 0);
  rig.place_at(1, 2, 0, 0);
  ASSERT_TRUE(rig.until(EventKind::link));
  rig.tick();
  EXPECT_EQ(rig.state.field, 1);  // one copy
  EXPECT_EQ(rig.state.ruleset, 0);
  rig.place_at(3, 2, 2, 0);
  ASSERT_TRUE(rig.until(EventKind::link));
  ASSERT_TRUE(rig.until(EventKind::command));
  EXPECT_EQ(rig.state.ruleset, 1);  // two copies: the ruleset that undoes them
  EXPECT_EQ(rig.events[0].a, 1);    // the second command of feedback
  rig.run(2);                       // a bond is evaluated in every tick
  EXPECT_GT(rig.count(EventKind::unlink), 0);
  EXPECT_EQ(rig.state.ruleset, 0);
}

TEST(Commands, TimedCommandsHoldBeforeTheFirstCopy) {
  Model model = hasty(2, {pairs(0), pairs(0), pairs(0)});
  model.commands = {{.at = 1, .kind = CommandKind::replace_ruleset, .ruleset = 1},
                    {.at = 2, .kind = CommandKind::pump_power, .field = 2}};
  model.feedback = {{.kind = CommandKind::replace_ruleset, .ruleset = 2, .copies = 1},
                    {.kind = CommandKind::pump_power, .copies = 1, .field = 1}};
  Rig rig(std::move(model), 1);
  rig.place(0, 0, 0);
  rig.run(100);
  EXPECT_EQ(rig.state.ruleset, 1);
  EXPECT_EQ(rig.state.field, 2);
  rig.place_at(1, 2, 0, 0);
  ASSERT_TRUE(rig.until(EventKind::link));
  rig.tick();
  EXPECT_EQ(rig.state.ruleset, 2);
  EXPECT_EQ(rig.state.field, 1);
}

TEST(Commands, FinalLabelsAreThoseThatNothingGoesOnFrom) {
  EXPECT_EQ(final_labels(chain()), (std::vector<std::array<int, 2>>{{7, 8}}));
  // A star of four grown on both of its first modules ends in two joins.
  const Ruleset twice = rules_of(
      "r1: (0,0) (0,0) -> (1,1)-(2,1) p=1\nr2: (1,3) (0,0) -> (3,1)-(4,1) p=1\n"
      "r3: (2,3) (0,0) -> (5,1)-(6,1) p=1\n");
  EXPECT_EQ(final_labels(twice), (std::vector<std::array<int, 2>>{{3, 4}, {5, 6}}));
}

}  // namespace
