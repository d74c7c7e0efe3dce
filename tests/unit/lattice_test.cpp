#include "lilytank/lattice.hpp"

#include <gtest/gtest.h>

#include "lilytank/synthesis.hpp"
#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::rules_of;
using lilytank::test::ruleset_file;
using lilytank::test::shipped_rulesets;

namespace {

Ruleset serial(const std::string& drawing, const std::vector<double>& p = {}) {
  const Target target = parse_target(drawing, "target.txt");
  EmitOptions options;
  options.p = p;
  return emit(target, make_plan(target, Algorithm::singleton), options);
}

TEST(ReactionNetwork, ChainGrowsAndShrinksByOne) {
  const ReactionNetwork network = reaction_network(serial("#####"));
  EXPECT_TRUE(network.closed);
  ASSERT_EQ(network.species.size(), 5u);
  ASSERT_EQ(network.reactions.size(), 7u);  // four joins, three undone
  for (const Reaction& reaction : network.reactions) {
    const int k = reaction.rule % 4;
    const std::vector<int> parts = {0, k}, whole = {k + 1};
    const bool link = reaction.kind == RuleKind::link;
    EXPECT_EQ(reaction.from, link ? parts : whole);
    EXPECT_EQ(reaction.to, link ? whole : parts);
    // Two single modules may meet with any of 4 x 4 faces; later one face of the chain will do.
    EXPECT_EQ(reaction.places, !link ? 1 : k == 0 ? 16 : 4);
  }
}

TEST(ReactionNetwork, AgreesWithTheSpeciesThatRunsAreJudgedBy) {
  for (const std::string& name : shipped_rulesets()) {
    const Ruleset rules = read_ruleset(ruleset_file(name));
    const ReactionNetwork network = reaction_network(rules);
    const SpeciesTable table = reachable_species(rules);
    EXPECT_EQ(network.species.size(), table.species.size()) << name;
    for (const Species& species : network.species) EXPECT_TRUE(table.contains(species.key)) << name;
    EXPECT_TRUE(network.blocked.empty()) << name;
    EXPECT_TRUE(network.unrestored.empty()) << name;
  }
}

TEST(ReactionNetwork, FindsTheGarbledLineOfThePapersCross) {
  Ruleset cross = read_ruleset(ruleset_file("cross5"));
  cross.rules[7].after[0].hop = 1;  // as printed: (5,1) instead of (5,2); its p is 0
  const RulesetCheck check = check_ruleset(cross);
  ASSERT_EQ(check.unrestored.size(), 1u);
  EXPECT_EQ(check.unrestored.begin()->first, 7);
  EXPECT_NE(check.unrestored.begin()->second.find("r4_reverse"), std::string::npos);
  EXPECT_FALSE(check.faults.empty());
}

TEST(ReactionNetwork, SlotsAreLeftOut) {
  // A cup is filled last by a module that engages one of its walls.
  const Target filled = parse_target("# #5#\n1   4\n#2#3#\n", "cup.txt");
  const Ruleset rules = emit(filled, make_plan(filled, Algorithm::plan));
  const ReactionNetwork network = reaction_network(rules);
  EXPECT_EQ(network.species.size(), 5u);
  ASSERT_EQ(network.blocked.size(), 1u);
  EXPECT_EQ(network.blocked[0].rule, 4);
  EXPECT_TRUE(network.blocked[0].to.empty());
  NetworkOptions all;
  all.sterics = false;
  EXPECT_EQ(reaction_network(rules, all).species.size(), 6u);
  EXPECT_FALSE(check_ruleset(rules).target_reached);
  // Where the opening's module hangs on the cup's bottom, it can come before the wall: labels
  // change at the two ends of a join only, so nothing makes it wait for the wall.
  const Target loose = parse_target("# # #\n1 5 4\n#2#3#\n", "cup.txt");
  const Ruleset stale = emit(loose, make_plan(loose, Algorithm::plan));
  EXPECT_EQ(reaction_network(stale).species.size(), 7u);
  ASSERT_EQ(reaction_network(stale).blocked.size(), 1u);
  EXPECT_FALSE(reaction_network(stale).blocked[0].to.empty());
  EXPECT_TRUE(check_ruleset(stale).target_reached);
}

// 15 modules in fives: assemblies of four that never fall apart are three at most, and there is
// room for three copies; of three, five.
TEST(PopulationGraph, PaperCasesOfDeadlock) {
  const auto deadlocks = [](const Ruleset& rules, int modules) {
    const PopulationGraph graph = population_graph(rules, reaction_network(rules), modules);
    EXPECT_TRUE(graph.complete);
    return graph.deadlocks().size();
  };
  const Ruleset safe = serial(".#.\n###\n.#.", {0.4857, 0.4086, 0});
  EXPECT_EQ(deadlocks(safe, 15), 0u);
  EXPECT_GT(deadlocks(safe, 24), 0u);
  EXPECT_GT(deadlocks(serial(".#.\n###\n.#.", {0.4857, 0, 0}), 15), 0u);
  EXPECT_EQ(deadlocks(serial("#####"), 24), 0u);  // everything but copies can fall apart
}

TEST(PopulationGraph, WithoutReverseRulesFifteenModulesEndWithoutEnough) {
  const Ruleset rules = serial("#####", {0, 0, 0, 0});
  const PopulationGraph graph = population_graph(rules, reaction_network(rules), 15);
  EXPECT_GT(graph.deadlocks().size(), 0u);
  for (const EndState& end : graph.ends) EXPECT_EQ(end.states, 1);
}

// All states looked at, against the two rules of counting.
TEST(PopulationGraph, DeadlockRulesForChainsUpToFiveAndSixteenModules) {
  int cases = 0, cautious = 0;
  for (int n = 3; n <= 5; ++n) {
    const std::string row(static_cast<std::size_t>(n), '#');
    for (int s = 2; s <= n; ++s) {
      std::vector<double> p(static_cast<std::size_t>(n - 1), 0);
      for (int k = 0; k < s - 2; ++k) p[static_cast<std::size_t>(k)] = 0.1;
      const Ruleset rules = serial(row, p);
      const ReactionNetwork network = reaction_network(rules);
      ASSERT_EQ(first_irreversible_size(rules, network), s);
      for (int m = n; m <= 16; ++m) {
        const PopulationGraph graph = population_graph(rules, network, m);
        ASSERT_TRUE(graph.complete);
        const bool found = !graph.deadlocks().empty();
        EXPECT_EQ(found, serial_deadlock(m, s, n)) << n << " " << s << " " << m;
        EXPECT_TRUE(!found || deadlock_risk(m, s, n)) << n << " " << s << " " << m;
        cautious += deadlock_risk(m, s, n) && !found ? 1 : 0;
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, 2 * 14 + 3 * 13 + 4 * 12);
  // 5 modules in threes: two pairs that last would leave one module, which completes one of them.
  EXPECT_TRUE(deadlock_risk(5, 2, 3));
  EXPECT_FALSE(serial_deadlock(5, 2, 3));
  EXPECT_GT(cautious, 0);
}

TEST(PopulationGraph, LimitIsTold) {
  const Ruleset rules = serial("#####");
  EXPECT_FALSE(population_graph(rules, reaction_network(rules), 15, 10).complete);
}

TEST(LatticeWorld, PaperRulesetsReachFullYield) {
  for (const std::string drawing : {"#####", ".#.\n###\n.#."}) {
    const Ruleset rules = serial(drawing, {0.05, 0.02, 0.002, 0});
    const ReactionNetwork network = reaction_network(rules);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      LatticeOptions options;
      options.seed = seed;
      options.evaluations = 1;
      options.attempts = 1000000;
      const LatticeResult result = run_lattice(rules, network, options);
      EXPECT_EQ(result.copies, 3) << drawing;
      EXPECT_EQ(result.illegal, 0);
      EXPECT_EQ(result.unrestored, 0);
      EXPECT_EQ(result.restored, result.links);
      EXPECT_EQ(result.double_bonds, 0);
      EXPECT_EQ(result.completion.size(), 3u);
    }
  }
}

TEST(LatticeWorld, SameSeedSameWorld) {
  const Ruleset rules = serial("##\n##");
  const ReactionNetwork network = reaction_network(rules);
  LatticeOptions options;
  options.attempts = 3000;
  const LatticeResult a = run_lattice(rules, network, options);
  const LatticeResult b = run_lattice(rules, network, options);
  EXPECT_EQ(a.standing, b.standing);
  EXPECT_EQ(a.links, b.links);
  options.seed = 2;
  EXPECT_NE(run_lattice(rules, network, options).refusals, a.refusals);
}

TEST(LatticeWorld, SeesWhatARulesetCannotMake) {
  const Ruleset rules = serial("#####");
  ReactionNetwork network = reaction_network(rules);
  network.species.pop_back();  // as if the finished chain were not known
  LatticeOptions options;
  options.attempts = 1000000;
  EXPECT_GT(run_lattice(rules, network, options).illegal, 0);
}

TEST(LatticeWorld, ClosureRulesFireWhenTheirContactIsEvaluatedLast) {
  const Target square = parse_target("##\n##", "o4.txt");
  EmitOptions emitting;
  emitting.p = {0.05, 0.02, 0};
  emitting.closures = true;
  const Ruleset rules = emit(square, make_plan(square, Algorithm::singleton), emitting);
  const ReactionNetwork network = reaction_network(rules);
  EXPECT_EQ(network.species.size(), 5u);  // the square with three bonds, and with four
  int open = 0, closed = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    LatticeOptions options;
    options.modules = 4, options.seed = seed;
    const LatticeResult result = run_lattice(rules, network, options);
    EXPECT_EQ(result.illegal, 0);
    ASSERT_EQ(result.copies, 1);
    ++(result.double_bonds > 0 ? closed : open);
  }
  // A fair coin, 40 times; both numbers are within 6 standard deviations of 20.
  EXPECT_GT(open, 1);
  EXPECT_GT(closed, 1);
}

TEST(RulesetCheck, SaysWhatItProved) {
  CheckOptions options;
  options.lattice_runs = 2;
  options.lattice.attempts = 2000;
  const Ruleset rules = serial("#####");
  const RulesetCheck check = check_ruleset(rules, options);
  EXPECT_TRUE(check.faults.empty());
  EXPECT_TRUE(check.target_reached);
  EXPECT_TRUE(check.target_stable);
  const std::string text = report_text(check_report(rules, check));
  for (const char* words :
       {"Check of ruleset target: no fault found\n8 rules\n", "5 kinds of assembly",
        "15 modules have", "3 of 3 copies", "no fault found", "2 lattice simulations", "0 illegal"})
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
}

TEST(RulesetCheck, NamesTheFaultsOfABadRuleset) {
  // The third rule makes a row of four into a row of six and so on: other shapes than the target.
  const Ruleset rules =
      rules_of("target\n  ###\nend\n(0,0) (0,0) -> (1,1)-(2,1)\n(2,3) (0,0) -> (3,1)-(2,1)\n");
  CheckOptions options;
  options.modules = 6;
  const RulesetCheck check = check_ruleset(rules, options);
  EXPECT_FALSE(check.other_finals.empty());
  EXPECT_FALSE(check.faults.empty());
}

}  // namespace
