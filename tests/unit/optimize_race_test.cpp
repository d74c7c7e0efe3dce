// Races of rulesets: what runs, what wins, and what is refused before the first world.
#include <gtest/gtest.h>

#include "optimize/source.hpp"
#include "support/optimize_rig.hpp"

namespace lilytank::test {
namespace {

/// Corners of three: the target has two rulesets, of which the scenario's own is one.
class RaceTest : public testing::Test {
 protected:
  RaceTest() {
    rig_.here.write("corner.rules",
                    "lilytank ruleset 1\nname corner\nhops counter-clockwise\n"
                    "target\n  #.\n  ##\nend\n"
                    "r1: (0,0) (0,0) -> (1,1)-(2,1)  p=1\nr2: (1,4) (0,0) -> (3,1)-(4,1)  p=1\n"
                    "r1_reverse: (1,1)-(2,1) -> (0,0) (0,0)  p=0.01\n"
                    "r2_reverse: (3,1)-(4,1) -> (1,2) (0,0)  p=0\n");
    rig_.here.write("corner.toml",
                    "base = \"pair.toml\"\n[run]\nduration = 30\n[ruleset]\nfile = "
                    "\"corner.rules\"\n");
  }
  static std::string head(const std::string& keys) {
    return "[optimize]\nscenario = \"corner.toml\"\nfitness = \"yield_area\"\n" + keys;
  }
  /// Races, expects the same files after interruptions, and that the overlay is what won.
  OptimizationResult race(const std::string& keys) {
    const OptimizationResult result = expect_same_files(
        rig_, head(kSearch + keys) + kReverse + kTwo,
        {"race.csv", "search.state", "evaluations.csv", "optimum.toml", "optimum.rules"});
    const Scenario read = load_scenario({rig_.here.path("corner.toml"), result.optimum}, {});
    rules_ = read.model.rulesets.front();
    std::vector<double> searched;
    for (const Rule& rule : rules_.rules) {
      if (rule.kind == RuleKind::unlink && rule.p > 0) searched.push_back(rule.p);
    }
    EXPECT_EQ(searched, result.best.point);
    return result;
  }
  static inline const std::string kReverse =
      "[[parameter]]\npath = \"rules.*_reverse.p\"\nlow = 0.001\nhigh = 1\n";
  static inline const std::string kTwo = "[race]\nrulesets = 2\nevaluations = 4\n";
  OptimizeRig rig_;
  Ruleset rules_;
};

TEST_F(RaceTest, ARulesetThatBuildsNothingLoses) {
  std::string own = rig_.here.read("corner.rules");
  own.replace(own.find("(4,1)  p=1") + 9, 1, "0");
  rig_.here.write("corner.rules", own);
  const OptimizationResult result = race("");
  ASSERT_EQ(result.race.size(), 2u);
  EXPECT_EQ(rules_.name, result.race[1].ruleset);
  ASSERT_TRUE(result.race[0].last && result.race[1].last);
  EXPECT_EQ(*result.race[0].last, 60);  // two copies that never stand
  EXPECT_LT(*result.race[1].last, 60);
  EXPECT_EQ(result.best.mean, *result.race[1].last);
}

// The other ruleset is its mirror image and no better. With this seed luck lets it win the race,
// and worlds that had no part in that tell.
TEST_F(RaceTest, ItsOwnRulesetIsGivenUpOnlyForABetterOne) {
  const OptimizationResult result = race("seed = 7\n");
  EXPECT_TRUE(result.race[1].kept);
  ASSERT_TRUE(result.race[0].last && result.race[1].last);
  EXPECT_LT(*result.race[0].last, *result.race[1].last);
  EXPECT_EQ(rules_.name, result.race[0].ruleset);
  EXPECT_EQ(result.best.mean, *result.race[0].last);
  EXPECT_EQ(result.best.point, std::vector<double>{0.01});  // as it was
}

// The larger the generations, the longer rulesets are judged at their start.
TEST_F(RaceTest, APopulationOfOnesOwnIsReckonedWith) {
  const std::string text = head("evaluations = 60\npopulation = 20\nfinal_evaluations = 5\n") +
                           kReverse + "[race]\nrulesets = 2\nevaluations = 24\n";
  const Optimization what = rig_.read(text);
  for (const auto& contestant : what.source().contestants) {
    EXPECT_EQ(contestant->generation(), 20 + 2);
  }
  OptimizationOptions options;
  options.out = rig_.here.path("out");
  EXPECT_FALSE(run_optimization(what, options).optimum.empty());
  EXPECT_TRUE(rig_.here.has("out/race/round-1/corner-own.csv"));
}

TEST_F(RaceTest, AWinnerThatCouldNotBeSearchedIsRefusedAtOnce) {
  EXPECT_NE(rig_.refused(head("evaluations = 25\npopulation = 20\nfinal_evaluations = 0\n") +
                         kReverse + kTwo)
                .find("a budget of 25 evaluations does not hold one generation of CMA-ES (22) and "
                      "the final selection (6)"),
            std::string::npos);
}

// What a scenario says of its own ruleset's rules is not about another one's.
TEST_F(RaceTest, RulesHaveNamesOfTheirOwn) {
  std::string own = rig_.here.read("corner.rules");
  for (auto at = own.find("_reverse"); at != std::string::npos; at = own.find("_reverse")) {
    own.replace(at, 8, "_back");
  }
  rig_.here.write("corner.rules", own);
  rig_.here.write("corner.toml", rig_.here.read("corner.toml") + "[rules]\nr1.p = 0.3\n");
  const std::string bounds = "low = 0.001\nhigh = 1\n";
  const std::string any = "[[parameter]]\npath = \"rules.*.p\"\n" + bounds + kTwo;
  const Optimization what = rig_.read(head(kSearch) + any, {"rules.r2.p=0.7"});
  ASSERT_EQ(what.source().contestants.size(), 2u);
  const auto p = [&](std::size_t contestant, const std::string& name) {
    const Scenario scenario = what.source().contestants[contestant]->scenario({0.5});
    for (const Rule& rule : scenario.model.rulesets.front().rules) {
      if (rule.name == name) return rule.p;
    }
    return -1.0;
  };
  EXPECT_EQ(p(0, "r1_back"), 0.5);
  EXPECT_EQ(p(0, "r1"), 0.3);
  EXPECT_EQ(p(1, "r1_reverse"), 0.5);
  EXPECT_EQ(p(1, "r1"), 1);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(p(i, "r2"), 0.7);  // by --set
  // An overlay with another ruleset could not be laid over these.
  const auto expect = [&](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  const std::string back = "[[parameter]]\npath = \"rules.*_back.p\"\n" + bounds + kTwo;
  expect(rig_.refused(head(kSearch) + back), "'rules.*_back.p' fits no rule of 'corner");
  expect(rig_.refused(head(kSearch) + any, {"rules.r1_back.p=0.02"}),
         "'rules.r1_back.p' is searched");
  expect(rig_.refused(head(kSearch) + any, {"rules.r2_back.p=0"}),
         "--set rules.r2_back.p=0: 'rules.r2_back.p' is no rule of 'corner");
  rig_.here.write("corner.toml", rig_.here.read("corner.toml") + "r1_back.p = 0.02\n");
  expect(rig_.refused(head(kSearch) + any),
         "corner.toml:8:13: 'rules.r1_back.p' is no rule of 'corner");
}

}  // namespace
}  // namespace lilytank::test
