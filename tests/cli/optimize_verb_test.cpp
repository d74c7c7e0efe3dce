// Searches end to end: what they find, whose directory it is, and what they leave alone.
#include <gtest/gtest.h>

#include "cli/refusals.hpp"

namespace lilytank {
namespace {

const std::string kOptimize = "[optimize]\nscenario = \"pair.toml\"\n";
const std::string kPart = "[[parameter]]\npath = \"rules.part.p\"\nlow = 0\nhigh = 1\n";
const std::string kChoose = "; choose another --out, or --force to replace it";

class OptimizeVerbTest : public RefusalTest {
 protected:
  OptimizeVerbTest() {
    const std::string few = "evaluations = 12\npopulation = 4\nfinal_evaluations = 4\n";
    lilytank_.here.write("sticky.toml", "[rules]\npart.p = 0\n");
    lilytank_.here.write("plain.toml", kOptimize + few + kPart);
    lilytank_.here.write("other.toml", kOptimize + "seed = 7\n" + few + kPart);
    lilytank_.here.write("compared.toml", kOptimize + few + kPart +
                                              "[compare]\nreplicates = 2\n"
                                              "overlays = [\"sticky.toml\"]\n");
  }
  void expect_there(const std::vector<std::string>& names, bool there) const {
    for (const std::string& name : names) EXPECT_EQ(lilytank_.here.has(name), there) << name;
  }
};

// All worlds of eight seconds are alike, so the swarm's first particle stays the best.
TEST_F(OptimizeVerbTest, AStartThatIsKeptIsNotComparedWithItself) {
  lilytank_.here.write("half.toml", "[rules]\npart.p = 0.5\n");
  lilytank_.here.write("kept.toml",
                       kOptimize + "method = \"swarm\"\nparticles = 2\niterations = 1\n" + kPart +
                           "[compare]\nreplicates = 2\noverlays = [\"half.toml\"]\n");
  const Answer a = lilytank_("optimize kept.toml --out a --quiet --set run.duration=0.1");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("half is the optimum itself and not compared with it\n"), std::string::npos)
      << a.out;
  expect_there({"a/compare/table.csv"}, true);
}

TEST_F(OptimizeVerbTest, WhereAllWorldsDivergeThereIsNoOptimum) {
  const Answer a = lilytank_(
      "optimize compared.toml --out a --quiet --set module.mass='0.1 g' "
      "--set forces.body_force.force_x=1");
  EXPECT_EQ(a.code, 1);
  EXPECT_EQ(a.out, "");
  EXPECT_EQ(a.err,
            "no optimum: at every point that was evaluated a simulation diverged; every value is "
            "in a\n");
  expect_there({"a/evaluations.csv"}, true);
  expect_there({"a/optimum.toml", "a/compare.toml"}, false);
}

TEST_F(OptimizeVerbTest, WhatIsNobodysIsNotReplaced) {
  for (const std::string name : {"optimum.toml", "compare.toml", "fitness.svg", "race.csv"}) {
    lilytank_.here.write(name + ".d/" + name, "mine\n");
    refused("optimize plain.toml --out " + name + ".d",
            "'" + name + ".d' holds a file '" + name + "' that is not of a search" + kChoose);
  }
  lilytank_.here.write("c/compare/summary.txt", "mine\n");
  refused("optimize compared.toml --out c",
          "'c' holds a file 'compare/summary.txt' that is not of a search" + kChoose);
  EXPECT_EQ(lilytank_("optimize plain.toml --out c --dry-run").code, 0);
  lilytank_.here.write("d/compare/study.toml", "[study]\nscenario = \"pair.toml\"\n");
  refused("optimize compared.toml --out d --force",
          "'d/compare/study.toml' is not of a study's results and would be overwritten; choose "
          "another --out");
  ASSERT_EQ(lilytank_("run tiny.toml --out r --quiet").code, 0);
  refused("optimize plain.toml --out r", "'r' holds a run" + kChoose);
}

TEST_F(OptimizeVerbTest, WhatIsReadIsSpared) {
  lilytank_.here.write("w/optimum.toml", "ruleset.file = \"optimum.rules\"\n");
  lilytank_.here.write("w/optimum.rules", test::kPairRulesText);
  const auto would = [](const std::string& file) {
    return "lilytank optimize: --out would overwrite '" + file +
           "', which is read; choose another name";
  };
  for (const std::string force : {"", " --force", " --force --dry-run"}) {
    refused("optimize plain.toml --overlay w/optimum.toml --out w" + force,
            would("w/optimum.toml"));
  }
  lilytank_.here.write("named.toml", "base = \"w/optimum.toml\"\n");
  refused("optimize plain.toml --overlay named.toml --out w --force", would("w/optimum.toml"));
  EXPECT_EQ(lilytank_("optimize plain.toml --overlay w/optimum.toml --out v --dry-run").code, 0);
}

TEST_F(OptimizeVerbTest, ForceLeavesNothingOfAnother) {
  ASSERT_EQ(lilytank_("optimize compared.toml --out a --quiet").code, 0);
  const std::vector<std::string> of_compare{"a/compare.toml", "a/compare/table.csv",
                                            "a/compare/study.toml"};
  expect_there(of_compare, true);
  const std::vector<std::string> mine{"a/notes.txt", "a/compare/notes.txt", "a/rulesets/x.rules"};
  for (const std::string& name : mine) lilytank_.here.write(name, "mine\n");
  // Its own files are not another's.
  const auto before = lilytank_.files("a");
  EXPECT_EQ(lilytank_("optimize compared.toml --out a --quiet --force").code, 0);
  EXPECT_EQ(lilytank_.files("a"), before);
  EXPECT_EQ(lilytank_("optimize other.toml --out a --quiet").code, 2);
  EXPECT_EQ(lilytank_.files("a"), before);
  EXPECT_EQ(lilytank_("optimize other.toml --out a --quiet --force").code, 0);
  expect_there(of_compare, false);
  expect_there(mine, true);
}

TEST_F(OptimizeVerbTest, ForceLeavesNothingOfARace) {
  lilytank_.here.write(
      "race.toml", lilytank_.here.read("plain.toml") + "[race]\nrulesets = 2\nevaluations = 2\n");
  ASSERT_EQ(lilytank_("optimize race.toml --out a --quiet").code, 0);
  const std::vector<std::string> of_race{"a/race.csv", "a/race", "a/rulesets", "a/optimum.rules"};
  expect_there(of_race, true);
  refused("optimize plain.toml --out a", "'a' holds another race" + kChoose);
  EXPECT_EQ(lilytank_("optimize plain.toml --out a --quiet --force").code, 0);
  expect_there(of_race, false);
  expect_there({"a/optimum.toml"}, true);
}

}  // namespace
}  // namespace lilytank
