#include <gtest/gtest.h>

#include <map>

#include "assemblies/pattern.hpp"
#include "lilytank/assembly_record.hpp"
#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::rules_of;
using lilytank::test::ruleset_file;
using lilytank::test::shipped_rulesets;

namespace {

std::map<int, std::vector<std::string>> drawings(const SpeciesTable& table) {
  std::map<int, std::vector<std::string>> by_size;
  for (const Species& s : table.species) by_size[s.size].push_back(s.drawing);
  return by_size;
}

TEST(Species, ChainHasOneOfEachSize) {
  const SpeciesTable table = reachable_species(read_ruleset(ruleset_file("chain5")));
  EXPECT_TRUE(table.closed);
  ASSERT_EQ(table.species.size(), 5u);
  for (const Species& s : table.species) {
    EXPECT_TRUE(s.drawing == std::string(s.size, '#') ||
                s.drawing.size() == static_cast<std::size_t>(2 * s.size - 1))
        << s.drawing;  // a row or a column
    EXPECT_EQ(s.target, s.size == 5);
    EXPECT_TRUE(s.legal);
    EXPECT_TRUE(table.contains(s.key));
  }
  EXPECT_FALSE(table.contains("0,0,9,0,0"));
}

TEST(Species, CrossGrowsCornerThenTThenCross) {
  const SpeciesTable table = reachable_species(read_ruleset(ruleset_file("cross5")));
  EXPECT_TRUE(table.closed);
  ASSERT_EQ(table.species.size(), 5u);
  const auto shapes = drawings(table);
  EXPECT_EQ(shapes.at(3).size(), 1u);
  EXPECT_EQ(std::count(shapes.at(3)[0].begin(), shapes.at(3)[0].end(), '.'), 1);  // a corner
  EXPECT_EQ(std::count(shapes.at(4)[0].begin(), shapes.at(4)[0].end(), '.'), 2);  // a T
  EXPECT_EQ(shapes.at(5)[0], ".#./###/.#.");
}

TEST(Species, ShippedRulesetsReachTheirTargetAndNothingElseOfItsSize) {
  for (const std::string& name : shipped_rulesets()) {
    const Ruleset rules = read_ruleset(ruleset_file(name));
    const SpeciesTable table = reachable_species(rules);
    EXPECT_TRUE(table.closed) << name;
    EXPECT_EQ(table.species.size(), rules.target.size()) << name;
    int targets = 0;
    for (const Species& s : table.species) targets += s.target ? 1 : 0;
    EXPECT_EQ(targets, 1) << name;
    EXPECT_TRUE(table.species.back().target) << name;
  }
}

TEST(Species, LAndJAreDifferentTargets) {
  Ruleset l = read_ruleset(ruleset_file("l4"));
  l.target = read_ruleset(ruleset_file("j4")).target;
  for (const Species& s : reachable_species(l).species) EXPECT_FALSE(s.target) << s.drawing;
}

TEST(Species, RulesWithoutProbabilityDoNotCount) {
  Ruleset chain = read_ruleset(ruleset_file("chain5"));
  chain.rules[2].p = 0;
  EXPECT_EQ(reachable_species(chain).species.size(), 3u);
}

// Two halves of a chain of six that grow apart and join last (two seeds, both sides with a hop).
TEST(Species, HalvesThatJoinLast) {
  const Ruleset rules = rules_of(
      "target\n######\nend\n(0,0) (0,0) -> (1,1)-(2,1) p=0.5\n(0,0) (0,0) -> (3,1)-(4,1) p=0.5\n"
      "(4,3) (0,0) -> (5,1)-(6,1)\n(2,3) (0,0) -> (7,1)-(8,1)\n(6,3) (8,3) -> (10,1)-(9,1)\n");
  const SpeciesTable table = reachable_species(rules);
  EXPECT_TRUE(table.closed);
  const auto shapes = drawings(table);
  EXPECT_EQ(shapes.at(2).size(), 2u);
  EXPECT_EQ(shapes.at(3).size(), 2u);
  EXPECT_EQ(shapes.count(4), 0u);
  EXPECT_EQ(shapes.count(5), 0u);
  ASSERT_EQ(shapes.at(6).size(), 1u);
  EXPECT_TRUE(table.species.back().target);
}

TEST(Species, UpdateRulesChangeLabelsOnly) {
  const SpeciesTable table =
      reachable_species(rules_of("(0,0) (0,0) -> (1,1)-(2,1)\n(1,1)-(2,1) -> (3,1)-(4,1)\n"));
  EXPECT_EQ(table.species.size(), 3u);
  EXPECT_EQ(drawings(table).at(2).size(), 2u);
}

TEST(Species, EndlessRulesetIsClosedForAFiniteWorldOnly) {
  const Ruleset endless = rules_of("(0,0) (0,0) -> (1,1)-(2,1)\n(2,3) (0,0) -> (2,1)-(2,1)\n");
  const SpeciesTable finite = reachable_species(endless, 4096, 8);
  EXPECT_TRUE(finite.closed);
  EXPECT_EQ(finite.species.size(), 8u);
  EXPECT_FALSE(reachable_species(endless, 5, 64).closed);
}

TEST(Species, AssembliesThatWouldOverlapDoNotJoin) {
  // The third rule would put a guest into the corner that the ring of hops has filled already.
  const Ruleset ring = rules_of(
      "(0,0) (0,0) -> (1,1)-(2,1)\n(2,2) (0,0) -> (3,1)-(4,1)\n(4,2) (0,0) -> (5,1)-(6,1)\n"
      "(6,2) (0,0) -> (7,1)-(8,1)\n");
  const auto shapes = drawings(reachable_species(ring));
  EXPECT_EQ(shapes.at(4)[0], "##/##");
  EXPECT_EQ(shapes.count(5), 0u);
}

TEST(Pattern, KeyReadsBackAndIgnoresTurns) {
  const Pattern corner = {{{0, 0}, 3, 1, 3u}, {{1, 0}, 2, 2, 4u}, {{0, 1}, 4, 3, 8u}};
  const std::string key = key_of(canonical(corner));
  EXPECT_EQ(key_of(canonical(pattern_of(key))), key);
  EXPECT_EQ(key_of(canonical(turned(turned(turned(corner))))), key);
  Pattern mirrored = corner;
  mirrored[0].label = 9;
  EXPECT_NE(key_of(canonical(mirrored)), key);
}

}  // namespace
