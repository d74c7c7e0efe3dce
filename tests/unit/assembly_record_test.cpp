#include "lilytank/assembly_record.hpp"

#include <gtest/gtest.h>

#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::quiet_model;
using lilytank::test::Rig;
using lilytank::test::rules_of;
using lilytank::test::ruleset_file;
using lilytank::test::with_p;

namespace {

/// Builds `copies` of a shipped ruleset's target (or all but its last `missing` modules) in a rig.
State built(const std::string& name, int modules, int copies, int missing = 0) {
  const Ruleset rules = with_p(read_ruleset(ruleset_file(name)), RuleKind::unlink, 0);
  const int size = static_cast<int>(rules.target.size());
  State all = lilytank::test::apart(quiet_model(modules, {}), 1);
  for (int copy = 0; copy < copies; ++copy) {
    Model model = quiet_model(size, {rules});
    model.control.clock = Clock::events;
    model.control.evaluation_rate = 40;
    Rig rig(std::move(model), 1);
    rig.place(0, 0, 0.5 * copy);
    for (int k = 1; k < size - missing; ++k) {
      rig.offer(k, rules.rules[k - 1].before[0], k & 3);
      EXPECT_TRUE(rig.until(EventKind::link));
      rig.run(10);
    }
    const int shift = copy * size;
    for (int i = 0; i < size - missing; ++i) {
      all.x[shift + i] = rig.state.x[i], all.y[shift + i] = rig.state.y[i];
      all.c[shift + i] = rig.state.c[i], all.s[shift + i] = rig.state.s[i];
      all.assembly[shift + i] = rig.state.assembly[i] + shift;
      all.cell_x[shift + i] = rig.state.cell_x[i], all.cell_y[shift + i] = rig.state.cell_y[i];
      all.turn[shift + i] = rig.state.turn[i];
      all.firmware[shift + i] = rig.state.firmware[i];
      for (int f = 0; f < 4; ++f) {
        Face& face = all.faces[4 * (shift + i) + f] = rig.state.faces[4 * i + f];
        if (face.partner >= 0) face.partner += shift;
        face.due = 0;  // of the rig's clock
      }
    }
  }
  return all;
}

Model model_of(int modules, std::vector<Ruleset> rulesets) {
  Model model = quiet_model(modules, std::move(rulesets));
  model.control.clock = Clock::events;
  model.control.evaluation_rate = 40;
  return model;
}

void run(World& world, AssemblyRecord& record, int steps) {
  for (int k = 0; k < steps; ++k) {
    ASSERT_EQ(world.step(), RunStatus::ok);
    record.observe(world);
  }
}

TEST(AssemblyRecord, CountsCopiesSizesAndModules) {
  const Ruleset rules = with_p(read_ruleset(ruleset_file("cross5")), RuleKind::unlink, 0);
  const Model model = model_of(13, {rules});
  World world(model, built("cross5", 13, 2));
  AssemblyRecord record(model);
  run(world, record, 1);
  EXPECT_EQ(record.copies(), 2);
  EXPECT_EQ(record.most_copies(), 2);
  EXPECT_EQ(record.possible_copies(), 2);
  EXPECT_EQ(record.by_size()[5], 2);
  EXPECT_EQ(record.by_size()[1], 3);
  EXPECT_EQ(record.illegal(), 0);
  for (int i = 0; i < 13; ++i) EXPECT_EQ(record.complete()[i], i < 10 ? 1 : 0);
  ASSERT_EQ(record.completion_times().size(), 2u);
  EXPECT_EQ(record.seen().size(), 2u);
}

TEST(AssemblyRecord, FollowsACopyThatFallsApart) {
  Ruleset rules = with_p(read_ruleset(ruleset_file("chain5")), RuleKind::unlink, 1);
  const Model model = model_of(5, {rules});
  World world(model, built("chain5", 5, 1));
  AssemblyRecord record(model);
  run(world, record, 30);
  EXPECT_EQ(record.copies(), 0);
  EXPECT_EQ(record.most_copies(), 1);  // at the first look
  EXPECT_EQ(record.by_size()[1], 5);
  EXPECT_EQ(record.seen().size(), 5u);
  EXPECT_EQ(record.illegal(), 0);
  const std::vector<std::int64_t> fired = {0, 0, 0, 0, 1, 1, 1, 1};
  EXPECT_EQ(record.firings()[0], fired);
  int standing = 0;
  for (const auto& [key, number] : record.standing()) standing += number;
  EXPECT_EQ(standing, 5);
}

TEST(AssemblyRecord, AMirroredShapeIsNoCopy) {
  Ruleset rules = with_p(read_ruleset(ruleset_file("l4")), RuleKind::unlink, 0);
  rules.target = read_ruleset(ruleset_file("j4")).target;
  const Model model = model_of(4, {rules});
  World world(model, built("l4", 4, 1));
  AssemblyRecord record(model);
  run(world, record, 2);
  EXPECT_EQ(record.copies(), 0);
  EXPECT_EQ(record.by_size()[4], 1);
}

TEST(AssemblyRecord, ALatchIsNoBond) {
  const Ruleset rules = rules_of("target\n##\nend\n(0,0) (0,0) -> (1,1)-(2,1) p=1e-09\n");
  const Model model = model_of(2, {rules});
  State state = lilytank::test::apart(model, 1);
  state.x[1] = state.x[0] + model.module.side;
  World world(model, state);
  AssemblyRecord record(model);
  run(world, record, 20);
  EXPECT_EQ(world.state().assembly[1], 0);
  EXPECT_EQ(record.by_size()[1], 2);
  EXPECT_EQ(record.copies(), 0);
}

TEST(AssemblyRecord, WithoutRulesetsLatchesCount) {
  const Model model = model_of(2, {});
  State state = lilytank::test::apart(model, 1);
  state.x[1] = state.x[0] + model.module.side;
  World world(model, state);
  AssemblyRecord record(model);
  run(world, record, 2);
  EXPECT_EQ(record.by_size()[2], 1);
  EXPECT_EQ(record.possible_copies(), 0);
  EXPECT_EQ(record.illegal(), 0);
}

TEST(AssemblyRecord, ForeignLabelsAreIllegalOnceForEachAppearance) {
  const Ruleset rules = with_p(read_ruleset(ruleset_file("chain5")), RuleKind::unlink, 0);
  const Model model = model_of(5, {rules});
  State state = built("chain5", 5, 1);
  state.firmware[2].label = 77;
  World world(model, state);
  AssemblyRecord record(model);
  run(world, record, 10);
  EXPECT_EQ(record.illegal(), 1);
  EXPECT_EQ(record.copies(), 1);  // the shape is right all the same
}

TEST(AssemblyRecord, WhatStandsAtARulesetChangeIsLegalUnderTheNewOne) {
  const Ruleset chain = with_p(read_ruleset(ruleset_file("chain5")), RuleKind::unlink, 0);
  const Ruleset cross = with_p(read_ruleset(ruleset_file("cross5")), RuleKind::unlink, 1);
  Model model = model_of(5, {chain, cross});
  model.commands = {{0.5, CommandKind::replace_ruleset, {}, 1}};
  World world(model, built("chain5", 5, 1));
  AssemblyRecord record(model);
  run(world, record, 15);
  EXPECT_EQ(record.copies(), 1);
  run(world, record, 40);
  EXPECT_EQ(world.state().ruleset, 1);
  EXPECT_EQ(record.illegal(), 0);
  EXPECT_EQ(record.copies(), 0);
  EXPECT_EQ(record.most_copies(), 0);  // another target: counted anew
  EXPECT_TRUE(record.completion_times().empty());
}

TEST(AssemblyRecord, NewProbabilitiesKeepTheCount) {
  const Ruleset slow = with_p(read_ruleset(ruleset_file("chain5")), RuleKind::unlink, 0);
  const Ruleset fast = with_p(slow, RuleKind::unlink, 1);
  Model model = model_of(5, {slow, fast});
  model.commands = {{0.5, CommandKind::replace_ruleset, {}, 1}};
  World world(model, built("chain5", 5, 1));
  AssemblyRecord record(model);
  run(world, record, 60);
  EXPECT_EQ(record.copies(), 0);
  EXPECT_EQ(record.most_copies(), 1);
  EXPECT_EQ(record.completion_times().size(), 1u);
  EXPECT_EQ(record.firings()[0][7], 0);
  EXPECT_EQ(record.firings()[1][7], 1);
  EXPECT_EQ(record.illegal(), 0);
}

TEST(AssemblyRecord, GoesOnFromItsText) {
  const Ruleset chain = with_p(read_ruleset(ruleset_file("chain5")), RuleKind::unlink, 0.05);
  const Model model = model_of(10, {chain});
  World world(model, built("chain5", 10, 2));
  AssemblyRecord record(model);
  run(world, record, 40);
  const State half = world.state();
  const std::string text = record.to_text();
  World again_world(model, half);
  AssemblyRecord again(model);
  again.restore(text, again_world);
  EXPECT_EQ(again.to_text(), text);
  EXPECT_EQ(again.standing(), record.standing());
  EXPECT_EQ(again.copies(), record.copies());
  run(world, record, 200);
  run(again_world, again, 200);
  EXPECT_EQ(again.to_text(), record.to_text());
  EXPECT_EQ(again.by_size(), record.by_size());
  EXPECT_EQ(again.standing(), record.standing());
  EXPECT_EQ(again.complete(), record.complete());
}

TEST(AssemblyRecord, RefusesTextThatDoesNotFit) {
  const Model model = model_of(5, {read_ruleset(ruleset_file("chain5"))});
  World world(model, built("chain5", 5, 1));
  AssemblyRecord record(model);
  run(world, record, 1);
  const std::string text = record.to_text();
  const std::string bad[] = {"",
                             "something else\n",
                             text.substr(0, text.size() - 4),  // cut before "end"
                             "lilytank assembly record 1\nruleset 3\nend\n",
                             "lilytank assembly record 1\nfired 0 99 1\nend\n",
                             "lilytank assembly record 1\nseen 0,0,0,-1 1\nend\n",
                             "lilytank assembly record 1\nseen 0,0,0,-1,0;999999,0,0,-1,0 1\nend\n",
                             "lilytank assembly record 1\nillegal many\nend\n",
                             "lilytank assembly record 1\nwords\nend\n"};
  for (const std::string& b : bad) EXPECT_THROW(record.restore(b, world), InputError) << b;
  EXPECT_EQ(record.to_text(), text);
}

}  // namespace
