#include "lilytank/synthesis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/control_rig.hpp"
#include "support/polyominoes.hpp"

using namespace lilytank;
using lilytank::test::one_sided_polyominoes;
using lilytank::test::ruleset_file;

namespace {

Ruleset singleton(const std::string& drawing) {
  const Target target = parse_target(drawing, "target.txt");
  return emit(target, make_plan(target, Algorithm::singleton));
}

/// One rule as the paper prints it.
std::string printed(const Rule& rule) {
  const auto label = [](const Label& l) {
    return "(" + std::to_string(l.state) + "," + std::to_string(l.hop) + ")";
  };
  const std::string before = rule.kind == RuleKind::link ? " " : "-";
  const std::string after = rule.kind == RuleKind::unlink ? " " : "-";
  return label(rule.before[0]) + before + label(rule.before[1]) + " -> " + label(rule.after[0]) +
         after + label(rule.after[1]);
}
std::vector<std::string> printed(const Ruleset& rules) {
  std::vector<std::string> lines;
  for (const Rule& rule : rules.rules) lines.push_back(rule.name + " " + printed(rule));
  return lines;
}

TEST(Synthesis, ChainOfFiveIsThePapersTable) {
  const std::vector<std::string> table = {
      "r1 (0,0) (0,0) -> (1,1)-(2,1)",         "r2 (1,3) (0,0) -> (3,1)-(4,1)",
      "r3 (4,3) (0,0) -> (5,1)-(6,1)",         "r4 (6,3) (0,0) -> (7,1)-(8,1)",
      "r1_reverse (1,1)-(2,1) -> (0,0) (0,0)", "r2_reverse (3,1)-(4,1) -> (1,3) (0,0)",
      "r3_reverse (5,1)-(6,1) -> (4,3) (0,0)", "r4_reverse (7,1)-(8,1) -> (6,3) (0,0)"};
  EXPECT_EQ(printed(singleton("#####")), table);
}

TEST(Synthesis, CrossOfFiveIsThePapersTableWithItsGarbledLineCorrected) {
  const std::vector<std::string> table = {
      "r1 (0,0) (0,0) -> (1,1)-(2,1)",         "r2 (1,2) (0,0) -> (3,1)-(4,1)",
      "r3 (3,3) (0,0) -> (5,1)-(6,1)",         "r4 (5,4) (0,0) -> (7,1)-(8,1)",
      "r1_reverse (1,1)-(2,1) -> (0,0) (0,0)", "r2_reverse (3,1)-(4,1) -> (1,4) (0,0)",
      "r3_reverse (5,1)-(6,1) -> (3,3) (0,0)", "r4_reverse (7,1)-(8,1) -> (5,2) (0,0)"};
  EXPECT_EQ(printed(singleton(".#.\n###\n.#.")), table);
}

// What the shipped files say, probabilities included.
TEST(Synthesis, ShippedRulesetsComeOutAgain) {
  for (const std::string& name : lilytank::test::shipped_rulesets()) {
    Ruleset file = read_ruleset(ruleset_file(name));
    Target target = target_of(file.target, file.name);
    const Ruleset made = emit(target, make_plan(target, Algorithm::singleton));
    EXPECT_EQ(printed(made), printed(file)) << name;
    for (std::size_t k = 0; k < made.rules.size(); ++k)
      EXPECT_EQ(made.rules[k].p, file.rules[k].p) << name << " " << made.rules[k].name;
  }
}

struct Golden {
  std::string drawing;
  std::vector<std::string> joins;  // from r2 on, "left hop state : reverse hop"
};

TEST(Synthesis, GoldenVectors) {
  const std::vector<Golden> all = {
      {"####", {"(1,3) 3", "(4,3) 3"}},
      {"#.\n#.\n##", {"(1,3) 3", "(4,4) 2"}},
      {".#\n.#\n##", {"(1,3) 3", "(4,2) 4"}},
      {"###\n.#.", {"(1,3) 3", "(3,4) 2"}},
      {".##\n##.", {"(1,4) 2", "(4,2) 4"}},
      {"##\n##", {"(1,2) 4", "(4,2) 4"}},
      {"##\n##\n#.", {"(1,4) 2", "(4,4) 2", "(6,3) 3"}},
  };
  for (const Golden& golden : all) {
    const Ruleset rules = singleton(golden.drawing);
    const std::size_t joins = rules.rules.size() / 2;
    ASSERT_EQ(joins, golden.joins.size() + 1) << golden.drawing;
    for (std::size_t k = 1; k < joins; ++k) {
      const Rule &forward = rules.rules[k], &reverse = rules.rules[joins + k];
      EXPECT_EQ(forward.before[1], Label{});
      EXPECT_EQ(reverse.after[1], Label{});
      EXPECT_EQ(reverse.after[0].state, forward.before[0].state);
      EXPECT_EQ("(" + std::to_string(forward.before[0].state) + "," +
                    std::to_string(forward.before[0].hop) + ") " +
                    std::to_string(reverse.after[0].hop),
                golden.joins[k - 1])
          << golden.drawing;
    }
  }
}

// The pattern of the authors' parallel chain of six: two seeds, two trimers, one join of both.
TEST(Synthesis, LinchpinJoinsTwoTrimersLast) {
  const Target target = parse_target("######", "chain6.txt");
  const Ruleset rules = emit(target, make_plan(target, Algorithm::linchpin));
  const std::vector<std::string> lines = printed(rules);
  EXPECT_EQ(lines[0], "r1 (0,0) (0,0) -> (1,1)-(2,1)");
  EXPECT_EQ(lines[1], "r2 (1,3) (0,0) -> (3,1)-(4,1)");
  EXPECT_EQ(lines[2], "r3 (0,0) (0,0) -> (5,1)-(6,1)");
  EXPECT_EQ(lines[3], "r4 (5,3) (0,0) -> (7,1)-(8,1)");
  EXPECT_EQ(lines[4], "r5 (4,3) (8,3) -> (9,1)-(10,1)");
  EXPECT_EQ(lines[9], "r5_reverse (9,1)-(10,1) -> (4,3) (8,3)");
  EXPECT_EQ(rules.rules[0].p, 0.5);
  EXPECT_EQ(rules.rules[2].p, 0.5);
  EXPECT_EQ(rules.rules[9].p, 0);
  EXPECT_EQ(rules.rules[5].p, rules.rules[7].p);
}

TEST(Synthesis, BalancedTakesAboutLog2StepsInDepth) {
  const Target target = parse_target("########", "chain8.txt");
  const Plan plan = make_plan(target, Algorithm::balanced);
  std::vector<int> depth(8, 0);  // of the part that a cell belongs to
  std::vector<int> part = {0, 1, 2, 3, 4, 5, 6, 7};
  int deepest = 0;
  for (const Contact& join : plan.joins) {
    const int a = part[static_cast<std::size_t>(join.a)],
              b = part[static_cast<std::size_t>(join.b)];
    const int made =
        1 + std::max(depth[static_cast<std::size_t>(a)], depth[static_cast<std::size_t>(b)]);
    for (int& p : part)
      if (p == b) p = a;
    depth[static_cast<std::size_t>(a)] = made;
    deepest = std::max(deepest, made);
  }
  EXPECT_EQ(deepest, 3);
}

TEST(Synthesis, LinchpinHasOneMaximalJoinOnAnyTree) {
  for (const auto& shape : one_sided_polyominoes(6)) {
    const Target target = target_of(shape, "shape");
    for (const auto& tree : spanning_trees(target, 1000)) {
      for (int edge = 0; edge < static_cast<int>(tree.size()); ++edge) {
        const std::vector<int> maximal = maximal_joins(target, linchpin_plan(target, tree, edge));
        ASSERT_EQ(maximal.size(), 1u);
        EXPECT_EQ(maximal[0], 4);
      }
    }
  }
}

// A single last join is possible in one-at-a-time growth exactly on caterpillars. The counts are
// those of all one-sided shapes of five to seven cells.
TEST(Synthesis, CaterpillarTheorem) {
  int without = 0, shapes = 0;
  for (const auto& shape : one_sided_polyominoes(7)) {
    const Target target = target_of(shape, "shape");
    bool any = false;
    for (const auto& tree : spanning_trees(target, 10000)) {
      const bool caterpillar = is_caterpillar(7, tree);
      any = any || caterpillar;
      const std::size_t maximal = maximal_joins(target, singleton_plan(target, tree)).size();
      EXPECT_EQ(maximal == 1, caterpillar);
    }
    ++shapes;
    without += any ? 0 : 1;
  }
  EXPECT_EQ(shapes, 196);
  EXPECT_EQ(without, 4);
}

TEST(Synthesis, PlanOfTheUserIsFollowed) {
  const Target target = parse_target("#2#1#3#", "plan.txt");
  ASSERT_TRUE(target.ordered);
  const Plan plan = make_plan(target, Algorithm::plan);
  ASSERT_EQ(plan.joins.size(), 3u);
  EXPECT_EQ(plan.joins[0], (Contact{1, 2}));
  EXPECT_EQ(plan.joins[1], (Contact{1, 0}));
  EXPECT_EQ(plan.joins[2], (Contact{2, 3}));
  EXPECT_EQ(maximal_joins(target, plan), (std::vector<int>{1, 2}));
  EXPECT_THROW(make_plan(parse_target("####", "plain.txt"), Algorithm::plan), InputError);
}

TEST(Synthesis, DrawnBondsAreTheTree) {
  const Target target = parse_target("#-#\n|\n#-#", "c.txt");
  const Plan plan = make_plan(target, Algorithm::singleton);
  for (const Contact& join : plan.joins)
    EXPECT_NE((Contact{std::min(join.a, join.b), std::max(join.a, join.b)}), (Contact{1, 3}));
  EXPECT_EQ(open_contacts(target, plan), (std::vector<Contact>{{1, 3}}));
}

TEST(Synthesis, ProbabilitiesAsAsked) {
  const Target target = parse_target("#####", "chain5.txt");
  EmitOptions options;
  options.p = {0.4796, 0.4203};
  const Ruleset rules = emit(target, make_plan(target, Algorithm::singleton), options);
  EXPECT_EQ(rules.rules[4].p, 0.4796);
  EXPECT_EQ(rules.rules[5].p, 0.4203);
  EXPECT_EQ(rules.rules[6].p, 0.000025);
  EXPECT_EQ(rules.rules[7].p, 0);
  options.p = {0.1, 0.1, 0.1, 0, 0};
  EXPECT_THROW(emit(target, make_plan(target, Algorithm::singleton), options), InputError);
  options.p = {1.5};
  EXPECT_THROW(emit(target, make_plan(target, Algorithm::singleton), options), InputError);
}

TEST(Synthesis, ClosureRulesHoldALoopThatIsFinished) {
  const Target square = parse_target("##\n##", "o4.txt");
  EmitOptions options;
  options.closures = true;
  const Ruleset rules = emit(square, make_plan(square, Algorithm::singleton), options);
  ASSERT_EQ(rules.rules.size(), 8u);
  EXPECT_EQ(rules.rules[3].name, "c1");
  EXPECT_EQ(rules.rules[3].kind, RuleKind::link);
  EXPECT_EQ(rules.rules[7].name, "c1_reverse");
  EXPECT_EQ(rules.rules[7].p, 0);
}

TEST(Synthesis, RulesReadBack) {
  for (const auto& shape : one_sided_polyominoes(5)) {
    const Target target = target_of(shape, "shape");
    for (const Algorithm algorithm :
         {Algorithm::singleton, Algorithm::linchpin, Algorithm::balanced}) {
      const Ruleset rules = emit(target, make_plan(target, algorithm));
      const Ruleset read = parse_ruleset(to_text(rules), "x.rules");
      EXPECT_EQ(printed(read), printed(rules));
      EXPECT_EQ(canonical_shape(read.target), canonical_shape(shape));
    }
  }
}

TEST(Synthesis, TooManyControlStatesAreRefused) {
  EXPECT_NO_THROW(singleton(std::string(128, '#')));
  EXPECT_THROW(singleton(std::string(129, '#')), InputError);
}

TEST(Plans, ChainOfFiveHasOneSerialPlanAndMoreParallelOnes) {
  const Target target = parse_target("#####", "chain5.txt");
  const PlanList list = all_plans(target);
  EXPECT_TRUE(list.complete);
  int serial = 0;
  for (const Plan& plan : list.plans) serial += plan.algorithm == Algorithm::singleton ? 1 : 0;
  EXPECT_EQ(serial, 1);
  EXPECT_GT(list.plans.size(), 1u);
  std::set<std::uint64_t> structures;
  for (const Plan& plan : list.plans) {
    EXPECT_NO_THROW(check_plan(target, plan));
    EXPECT_TRUE(structures.insert(structure_of(emit(target, plan))).second);
  }
}

TEST(Plans, NamesDoNotMakeAPlan) {
  const Target target = parse_target(".#.\n###\n.#.", "cross5.txt");
  const Ruleset rules = emit(target, make_plan(target, Algorithm::singleton));
  Ruleset renamed = rules;
  for (Rule& rule : renamed.rules) {
    rule.name += "x";
    for (Label* label : {&rule.before[0], &rule.before[1], &rule.after[0], &rule.after[1]})
      if (label->state != 0) label->state = 9 - label->state;
  }
  std::reverse(renamed.rules.begin(), renamed.rules.end());
  EXPECT_EQ(structure_of(renamed), structure_of(rules));
  renamed.rules[0].before[0].hop ^= 1;
  EXPECT_NE(structure_of(renamed), structure_of(rules));
  const Target l = parse_target("#.\n#.\n##", "l4.txt");
  EXPECT_NE(structure_of(emit(l, make_plan(l, Algorithm::singleton))),
            structure_of(emit(mirrored(l), make_plan(mirrored(l), Algorithm::singleton))));
}

TEST(Plans, LimitsAreTold) {
  const Target target = parse_target("###\n###\n###", "o9.txt");
  PlanLimits limits;
  limits.trees = 5, limits.orders = 10, limits.plans = 20;
  const PlanList list = all_plans(target, limits);
  EXPECT_FALSE(list.complete);
  EXPECT_LE(list.plans.size(), 20u);
  EXPECT_FALSE(list.plans.empty());
}

std::set<NoteKind> kinds(const std::string& drawing, Algorithm algorithm, int modules) {
  const Target target = parse_target(drawing, "target.txt");
  const Plan plan = make_plan(target, algorithm);
  std::set<NoteKind> found;
  for (const Note& note : notes_on(target, plan, emit(target, plan), modules))
    found.insert(note.kind);
  return found;
}

TEST(Notes, SayWhatMatters) {
  EXPECT_TRUE(kinds("#####", Algorithm::singleton, 15).empty());
  EXPECT_EQ(kinds("#.\n#.\n##", Algorithm::singleton, 15), (std::set{NoteKind::chirality}));
  EXPECT_EQ(kinds("##\n##", Algorithm::singleton, 15), (std::set{NoteKind::loops}));
  EXPECT_TRUE(kinds("#####", Algorithm::linchpin, 15).count(NoteKind::seeds));
  EXPECT_EQ(kinds("#....\n#....\n###..\n..#..\n..#..", Algorithm::singleton, 0),
            (std::set<NoteKind>{NoteKind::chirality}));
  // Three arms of two: not a caterpillar.
  const auto arms = kinds("..#..\n..#..\n#####", Algorithm::singleton, 14);
  EXPECT_TRUE(arms.count(NoteKind::caterpillar));
  EXPECT_TRUE(arms.count(NoteKind::maximal));
  EXPECT_FALSE(kinds("..#..\n..#..\n#####", Algorithm::linchpin, 14).count(NoteKind::maximal));
}

TEST(Notes, DeadlockRiskDependsOnTheNumberOfModules) {
  const Target target = parse_target("#####", "chain5.txt");
  const Plan plan = make_plan(target, Algorithm::singleton);
  EmitOptions options;
  options.p = {0.5, 0.4, 0};
  const Ruleset rules = emit(target, plan, options);
  const auto risk = [&](int modules) {
    for (const Note& note : notes_on(target, plan, rules, modules))
      if (note.kind == NoteKind::deadlock) return true;
    return false;
  };
  EXPECT_FALSE(risk(15));
  EXPECT_TRUE(risk(24));
  EXPECT_FALSE(risk(0));
}

TEST(Sterics, ASlotAsWideAsAModuleLetsNothingIn) {
  // A cup whose opening is filled last: the guest would have to slide between two walls.
  const Target filled = parse_target("# # #\n1 5 4\n#2#3#\n", "cup.txt");
  const Plan last = make_plan(filled, Algorithm::plan);
  EXPECT_EQ(blocked_joins(filled, last), (std::vector<int>{4}));
  bool warned = false;
  for (const Note& note : notes_on(filled, last, emit(filled, last), 0))
    warned = warned || note.kind == NoteKind::sterics;
  EXPECT_TRUE(warned);
  // Filled before the second wall stands, the same module comes past one wall only.
  const Target early = parse_target("# # #\n1 3 5\n#2#4#\n", "cup.txt");
  EXPECT_TRUE(blocked_joins(early, make_plan(early, Algorithm::plan)).empty());
  for (const Algorithm algorithm : {Algorithm::singleton, Algorithm::linchpin, Algorithm::balanced})
    EXPECT_TRUE(blocked_joins(filled, make_plan(target_of(filled.cells, "o6"), algorithm)).empty());
}

TEST(Stages, ShowLabelsHopsAndBonds) {
  const Target target = parse_target("#####", "chain5.txt");
  const auto stages = stages_of(target, make_plan(target, Algorithm::singleton));
  ASSERT_EQ(stages.size(), 5u);
  EXPECT_EQ(stages[0].modules.size(), 1u);
  EXPECT_EQ(stages[0].modules[0].label, 0);
  EXPECT_EQ(stages[4].modules.size(), 5u);
  EXPECT_EQ(stages[4].rule, "r4");
  std::vector<int> labels;
  for (const StageModule& module : stages[4].modules) labels.push_back(module.label);
  EXPECT_EQ(labels, (std::vector<int>{2, 3, 5, 7, 8}));
  EXPECT_EQ(stages[4].modules[4].last, 2);
  EXPECT_EQ(stages[4].modules[2].bonds, 5u);
}

}  // namespace
