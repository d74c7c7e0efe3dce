// Rules for every small shape, checked on the lattice.
#include <gtest/gtest.h>

#include <set>

#include "assemblies/pattern.hpp"
#include "lilytank/lattice.hpp"
#include "lilytank/synthesis.hpp"
#include "support/polyominoes.hpp"

using namespace lilytank;
using lilytank::test::one_sided_polyominoes;

namespace {

constexpr Algorithm kAlgorithms[] = {Algorithm::singleton, Algorithm::linchpin,
                                     Algorithm::balanced};

/// The assemblies that a plan allows, without its rules: connected sets of its bonds that are, at
/// every module, the first few of those that the module makes.
std::set<std::string> legal_species(const Target& target, const Plan& plan) {
  const std::size_t n = target.cells.size(), joins = plan.joins.size();
  std::vector<std::vector<std::size_t>> of(n);  // joins of a cell, in their order
  for (std::size_t k = 0; k < joins; ++k) {
    of[static_cast<std::size_t>(plan.joins[k].a)].push_back(k);
    of[static_cast<std::size_t>(plan.joins[k].b)].push_back(k);
  }
  std::set<std::string> keys = {key_of(canonical({PatternModule{}}))};
  for (unsigned set = 1; set < 1u << joins; ++set) {
    Pattern pattern;
    bool prefix = true;
    for (std::size_t c = 0; c < n && prefix; ++c) {
      PatternModule m;
      m.cell = target.cells[c];
      bool ended = false;
      for (const std::size_t k : of[c]) {
        if ((set >> k & 1u) == 0) {
          ended = true;
          continue;
        }
        prefix = prefix && !ended;
        const Contact& join = plan.joins[k];
        const bool first = join.a == static_cast<int>(c);
        m.last = direction_of(target, static_cast<int>(c), first ? join.b : join.a);
        m.label = static_cast<int>(2 * k + (first ? 1 : 2));
        m.bonds |= 1u << m.last;
      }
      if (m.bonds != 0) pattern.push_back(m);
    }
    // As many modules as bonds and one more: connected, as there are no loops.
    int bonds = 0;
    for (std::size_t k = 0; k < joins; ++k) bonds += (set >> k & 1u) != 0 ? 1 : 0;
    if (prefix && static_cast<int>(pattern.size()) == bonds + 1)
      keys.insert(key_of(canonical(pattern)));
  }
  return keys;
}

TEST(LatticeCheck, EveryShapeUpToSixModulesIsBuiltAndNothingElse) {
  int shapes = 0, plans = 0;
  for (int n = 2; n <= 6; ++n) {
    for (const auto& shape : one_sided_polyominoes(n)) {
      ++shapes;
      const Target target = target_of(shape, "shape");
      for (const Algorithm algorithm : kAlgorithms) {
        const Plan plan = make_plan(target, algorithm);
        // All but the last join are often undone: much happens, and nothing can get stuck.
        EmitOptions emitting;
        for (int k = 0; k < n - 1; ++k) emitting.p.push_back(k == n - 2 ? 0 : 0.02);
        const Ruleset rules = emit(target, plan, emitting);
        const ReactionNetwork network = reaction_network(rules);
        ASSERT_TRUE(network.closed);
        std::set<std::string> reached;
        for (const Species& species : network.species) reached.insert(species.key);
        EXPECT_EQ(reached, legal_species(target, plan)) << to_text(target) << to_text(rules);
        EXPECT_TRUE(network.unrestored.empty());
        EXPECT_TRUE(network.blocked.empty()) << to_text(target);
        LatticeOptions options;
        options.modules = 2 * n + 1;
        options.attempts = 300000;
        const LatticeResult result = run_lattice(rules, network, options);
        EXPECT_EQ(result.illegal, 0) << result.first_illegal;
        EXPECT_EQ(result.unrestored, 0);
        EXPECT_EQ(result.double_bonds, 0);
        EXPECT_FALSE(result.completion.empty()) << to_text(target) << to_text(rules);
        ++plans;
      }
    }
  }
  EXPECT_EQ(shapes, 1 + 2 + 7 + 18 + 60);
  EXPECT_EQ(plans, 3 * shapes);
}

// Shapes of up to five modules, all plans: the target is built and stays, reverse rules undo, and
// where one join only is maximal, two copies come to stand from every state.
TEST(LatticeCheck, EveryPlanOfSmallShapes) {
  int plans = 0;
  for (int n = 2; n <= 5; ++n) {
    for (const auto& shape : one_sided_polyominoes(n)) {
      const Target target = target_of(shape, "shape");
      const PlanList list = all_plans(target);
      ASSERT_TRUE(list.complete);
      for (const Plan& plan : list.plans) {
        ++plans;
        const Ruleset rules = emit(target, plan);
        CheckOptions options;
        options.modules = 2 * n;
        options.lattice_runs = 1;
        options.lattice.attempts = 500;
        const RulesetCheck check = check_ruleset(rules, options);
        EXPECT_TRUE(check.target_reached);
        EXPECT_TRUE(check.target_stable);
        EXPECT_TRUE(check.unrestored.empty());
        EXPECT_TRUE(check.other_finals.empty());
        EXPECT_TRUE(check.population.complete);
        const bool safe = maximal_joins(target, plan).size() > 1 || check.faults.empty();
        EXPECT_TRUE(safe) << to_text(target) << report_text(check_report(rules, check));
      }
    }
  }
  EXPECT_GT(plans, 60);
}

}  // namespace
