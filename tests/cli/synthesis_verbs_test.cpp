// lilytank synthesize and check: what users see.
#include <gtest/gtest.h>

#include "cli/program.hpp"
#include "io/file_digest.hpp"
#include "lilytank/ruleset.hpp"
#include "support/study_rig.hpp"

namespace lilytank {
namespace {

const std::string kTargets = LILYTANK_SOURCE_DIR "/scenarios/targets/";
const std::string kRulesets = LILYTANK_SOURCE_DIR "/scenarios/rulesets/";

std::vector<std::string> words_of(const std::vector<Rule>& rules) {
  std::vector<std::string> words;
  Ruleset one;
  for (const Rule& rule : rules) {
    one.rules = {rule};
    words.push_back(to_text(one));
  }
  return words;
}

TEST(SynthesizeVerb, MakesTheShippedRulesets) {
  const Program lilytank;
  for (const std::string name :
       {"chain5", "cross5", "i4", "l4", "j4", "t4", "s4", "o4", "p5", "caterpillar7", "arms7"}) {
    const std::string algorithm = name == "arms7" ? " --algorithm linchpin" : "";
    const Answer a = lilytank("synthesize '" + kTargets + name + ".txt'" + algorithm +
                              " --out made.rules --force");
    ASSERT_EQ(a.code, 0) << a.err;
    EXPECT_EQ(a.out, "");
    const Ruleset made = read_ruleset(lilytank.here.path("made.rules"));
    const Ruleset shipped = read_ruleset(kRulesets + name + ".rules");
    EXPECT_EQ(words_of(made.rules), words_of(shipped.rules)) << name;
    EXPECT_EQ(canonical_shape(made.target), canonical_shape(shipped.target)) << name;
    EXPECT_EQ(made.name, name);
  }
}

TEST(SynthesizeVerb, ScenariosOfTheTargetsRun) {
  const Program lilytank;
  for (const std::string name :
       {"i4", "l4", "j4", "t4", "s4", "o4", "p5", "caterpillar7", "arms7"}) {
    const Answer a = lilytank("run '" LILYTANK_SOURCE_DIR "/scenarios/" + name +
                              ".toml' --set run.duration='2 s' --quiet --out " + name);
    EXPECT_EQ(a.code, 0) << a.err;
  }
}

TEST(SynthesizeVerb, WarnsInPlainWords) {
  const Program lilytank;
  lilytank.here.write("l.txt", "#.\n#.\n##\n");
  Answer a = lilytank("synthesize l.txt");
  EXPECT_EQ(a.code, 0);
  EXPECT_NE(a.err.find("never its mirror image"), std::string::npos) << a.err;
  EXPECT_NE(a.out.find("# Note: the shape is handed"), std::string::npos) << a.out;
  a = lilytank("synthesize '" + kTargets + "arms7.txt' --modules 24");
  for (const char* words : {"warning: the finished shape has 2 joins that can be taken back",
                            "not a caterpillar", "24 modules can all be bound"})
    EXPECT_NE(a.err.find(words), std::string::npos) << a.err;
  a = lilytank("synthesize '" + kTargets + "arms7.txt' --algorithm linchpin");
  EXPECT_NE(a.err.find("3 rules compete for two single modules"), std::string::npos) << a.err;
  a = lilytank("synthesize '" + kTargets + "o4.txt' --closures");
  EXPECT_NE(a.err.find("closure rules hold 1"), std::string::npos) << a.err;
  a = lilytank("synthesize '" + kTargets + "chain5.txt' --p 0.5,0.4,0 --modules 24");
  EXPECT_NE(a.err.find("6 assemblies of 4 modules"), std::string::npos) << a.err;
  EXPECT_NE(a.out.find("p=0.4\n"), std::string::npos) << a.out;
}

TEST(SynthesizeVerb, TakesTreesOrdersAndAllPlans) {
  const Program lilytank;
  lilytank.here.write("o4.txt", "##\n##\n");
  lilytank.here.write("tree.txt", "#-#\n|\n#-#\n");
  lilytank.here.write("order.txt", "#3#\n1\n#2#\n");
  EXPECT_EQ(lilytank("synthesize o4.txt --tree tree.txt").code, 0);
  const Answer a = lilytank("synthesize o4.txt --order order.txt");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("algorithm plan"), std::string::npos) << a.out;
  EXPECT_EQ(lilytank("synthesize order.txt").out.substr(0, 60), a.out.substr(0, 60));
  const Answer all = lilytank("synthesize o4.txt --all plans");
  EXPECT_EQ(all.code, 0) << all.err;
  const auto names = lilytank.names("plans");
  EXPECT_GT(names.size(), 1u);
  for (const std::string& name : names)
    EXPECT_NO_THROW(read_ruleset(lilytank.here.path("plans/" + name)));
}

TEST(SynthesizeVerb, RefusesWithOneLine) {
  const Program lilytank;
  lilytank.here.write("o4.txt", "##\n##\n");
  lilytank.here.write("i3.txt", "#-#-#\n");
  lilytank.here.write("loop.txt", "#-#\n| |\n#-#\n");
  lilytank.here.write("bad.txt", "##\n#!\n");
  const struct {
    std::string words, message;
  } cases[] = {
      {"", "one target, please"},
      {"none.txt", "none.txt"},
      {"bad.txt", "bad.txt:2:2: '!' in a drawing"},
      {"o4.txt --algorithm singelton", "did you mean 'singleton'?"},
      {"o4.txt --algorithm plan", "needs a drawing whose bonds are numbered"},
      {"o4.txt --tree i3.txt", "draws other cells"},
      {"o4.txt --tree loop.txt", "4 bonds are drawn, a tree of 4 modules has 3"},
      {"o4.txt --order loop.txt", "has no numbered bonds"},
      {"o4.txt --p 0.1,x", "'x' is not a probability"},
      {"o4.txt --p 0.1,0.1,0.1,0.1", "4 probabilities are given for 3 joins"},
      {"o4.txt --name 4o", "'4o' is not a name"},
      {"o4.txt --modules 0", "--modules 0 is outside"},
      {"o4.txt --figure f.jpg", "must end in .png, .svg or .pdf"},
  };
  for (const auto& c : cases) {
    const Answer a = lilytank("synthesize " + c.words + " --out x.rules");
    EXPECT_EQ(a.code, 2) << c.words;
    EXPECT_NE(a.err.find(c.message), std::string::npos) << c.words << "\n" << a.err;
    EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
  }
  for (const std::string& name : lilytank.names()) EXPECT_NE(name, "x.rules");
}

TEST(CheckVerb, ProvesThePapersRulesets) {
  const Program lilytank;
  for (const std::string name : {"chain5", "cross5"}) {
    const Answer a = lilytank("check '" + kRulesets + name + ".rules' --lattice 2 --attempts 2000");
    EXPECT_EQ(a.code, 0) << a.err;
    for (const char* words : {"15 modules have 84 states and end in 1 way", "3 of 3 copies",
                              "every reverse rule gives back", "0 illegal assemblies", "no fault"})
      EXPECT_NE(a.out.find(words), std::string::npos) << a.out;
  }
}

TEST(CheckVerb, FindsFaultsAndSaysSoInItsExitCode) {
  const Program lilytank;
  ASSERT_EQ(lilytank("synthesize '" + kTargets + "chain5.txt' --p 0.5,0.4,0 --out c.rules").code,
            0);
  EXPECT_EQ(lilytank("check c.rules --lattice 0").code, 0);
  const Answer a = lilytank("check c.rules --lattice 0 --modules 24");
  EXPECT_EQ(a.code, 1);
  EXPECT_NE(a.out.find("fault: 1 deadlock"), std::string::npos) << a.out;
  EXPECT_NE(a.out.find("6 x ####"), std::string::npos) << a.out;
}

TEST(CheckVerb, CountsRatesAndGoesOnAfterAStop) {
  const Program lilytank;
  const std::string words = "check '" + kRulesets +
                            "chain5.rules' --lattice 0 --measure '" LILYTANK_SOURCE_DIR
                            "/scenarios/chain5.toml' --duration '4 min' --gillespie 20 --quiet";
  const Answer one = lilytank(words + " --worlds 1 --out a");
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_NE(one.out.find("copies, simulations 0 (-)"), std::string::npos) << one.out;
  EXPECT_EQ(one.out.find("inf"), std::string::npos) << one.out;
  EXPECT_EQ(lilytank.here.read("a/yield.csv").find("inf"), std::string::npos);
  ASSERT_EQ(lilytank(words + " --worlds 2 --out a --kappa a.ka --bngl a.bngl").code, 0);
  const Answer b = lilytank(words + " --worlds 3 --out b");
  ASSERT_EQ(b.code, 0) << b.err;
  const auto first = lilytank.files("a"), second = lilytank.files("b");
  EXPECT_EQ(first.at("world-1-2.csv"), second.at("world-1-2.csv"));
  EXPECT_EQ(second.count("world-1-3.csv"), 1u);
  for (const char* name : {"rates.csv", "yield.csv"}) EXPECT_EQ(second.count(name), 1u) << name;
  // The missing world is added to those that are there.
  ASSERT_EQ(lilytank(words + " --worlds 3 --out a").code, 0);
  EXPECT_EQ(lilytank.files("a"), second);
  // Another scenario's worlds are not taken.
  const Answer other = lilytank(words + " --worlds 3 --out a --set tank.radius=0.29");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("holds another check"), std::string::npos) << other.err;
  // Rates serve again, without worlds.
  const Answer again = lilytank("check '" + kRulesets +
                                "chain5.rules' --lattice 0 --rates a/rates.csv --gillespie 10");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.out.find("well-mixed model, 10 runs of 4 h"), std::string::npos) << again.out;
  EXPECT_NE(lilytank.here.read("a.ka").find("%agent: M("), std::string::npos);
  EXPECT_NE(lilytank.here.read("a.bngl").find("begin reaction rules"), std::string::npos);
}

TEST(CheckVerb, MeasuresWorldsAsTheScenarioSays) {
  const Program lilytank;
  lilytank.here.write("pair.rules", test::kPairRulesText);
  lilytank.here.write("pair.toml", test::kPairScenario);
  lilytank.here.write("loose.toml", "[rules]\npart.p = 1\n");
  const std::string words =
      "check pair.rules --lattice 0 --measure pair.toml --duration '2 min' --worlds 1 "
      "--gillespie 2 --quiet ";
  const Answer plain = lilytank(words + "--out a");
  ASSERT_EQ(plain.code, 0) << plain.err;
  EXPECT_EQ(plain.out.find("p as the scenario sets it"), std::string::npos) << plain.out;
  EXPECT_NE(plain.out.find("6 modules have"), std::string::npos) << plain.out;
  for (const std::string more : {"--measure loose.toml --out b", "--set rules.part.p=1 --out c"}) {
    const Answer loose = lilytank(words + more);
    ASSERT_EQ(loose.code, 0) << loose.err;
    EXPECT_NE(loose.out.find("warning: p as the scenario sets it: part 1 (ruleset: 0.5)\n"),
              std::string::npos)
        << loose.out;
  }
  EXPECT_NE(lilytank.files("b").at("world-1-1.csv"), lilytank.files("a").at("world-1-1.csv"));
  EXPECT_EQ(lilytank.files("b").at("rates.csv"), lilytank.files("c").at("rates.csv"));
  const Answer fewer = lilytank(words + "--set module.count=4 --out d");
  ASSERT_EQ(fewer.code, 0) << fewer.err;
  EXPECT_NE(fewer.out.find("4 modules have"), std::string::npos) << fewer.out;
  const auto results = [](const std::string& out) {
    return out.substr(0, out.find("\nProvenance"));
  };
  EXPECT_EQ(results(lilytank(words + "--modules 4 --out e").out), results(fewer.out));
  EXPECT_NE(lilytank.here.read("d/report.html").find("Rates and well-mixed model"),
            std::string::npos);
  EXPECT_EQ(lilytank.files("d").at("rates.csv"), lilytank.files("e").at("rates.csv"));
}

TEST(CheckVerb, DivergedWorldsAreCountedAndTheExitCodeSaysSo) {
  const Program lilytank;
  lilytank.here.write("pair.rules", test::kPairRulesText);
  lilytank.here.write("pair.toml", test::kPairScenario);
  const std::string words =
      "check pair.rules --lattice 0 --measure pair.toml --duration '2 min' --worlds 2 "
      "--gillespie 2 --quiet --out ";
  const Answer all =
      lilytank(words + "a --set module.mass='0.1 g' --set forces.body_force.force_x=1");
  EXPECT_EQ(all.code, 1) << all.err;
  EXPECT_NE(all.out.find("all 2 simulations diverged"), std::string::npos) << all.out;
  ASSERT_EQ(lilytank(words + "b").code, 0);
  // As if the second of the worlds that are kept had diverged.
  std::string kept = lilytank.here.read("b/world-1-2.csv");
  kept.replace(kept.find(",,,0,0\n", kept.find("scenario,")), 7, ",,,1,0\n");
  kept.resize(kept.rfind("# checksum "));
  lilytank.here.write("b/world-1-2.csv", with_checksum_line(kept));
  const Answer some = lilytank(words + "b");
  EXPECT_EQ(some.code, 1) << some.err;
  EXPECT_NE(some.out.find("1 of 2 simulations diverged"), std::string::npos) << some.out;
  EXPECT_NE(some.out.find("rates from 1 simulation,"), std::string::npos) << some.out;
}

// What is counted while a world runs, and from the events that a run stores, is the same.
TEST(CheckVerb, RatesOfAStoredRun) {
  const Program lilytank;
  ASSERT_EQ(lilytank("run '" LILYTANK_SOURCE_DIR
                     "/scenarios/chain5.toml' --set run.duration='4 min' --quiet --out r")
                .code,
            0);
  const Answer a = lilytank("check '" + kRulesets + "chain5.rules' --lattice 0 --rates r --out c");
  ASSERT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("rates from 1 simulation, 0.0667 h"), std::string::npos) << a.out;
  EXPECT_EQ(lilytank.here.read("c/rates.csv").find("evaluations,,,,-1,"), std::string::npos);
  std::filesystem::remove(lilytank.here.path("r/summary.json"));
  const Answer begun = lilytank("check '" + kRulesets + "chain5.rules' --lattice 0 --rates r");
  EXPECT_EQ(begun.code, 2);
  EXPECT_EQ(begun.err,
            "the run in 'r' is not over: it has no summary.json; lilytank run goes on with it\n");
}

TEST(CheckVerb, RefusesWithOneLine) {
  const Program lilytank;
  const std::string chain = "'" + kRulesets + "chain5.rules' --lattice 0 ";
  const std::string tank = LILYTANK_SOURCE_DIR "/scenarios/chain5.toml";
  const std::string measured = chain + "--measure '" + tank + "' ";
  lilytank.here.write("pair.rules", test::kPairRulesText);
  lilytank.here.write("pause.toml",
                      "base = \"" + tank + "\"\n[[command]]\nat = 1\ndo = \"pause\"\n");
  const struct {
    std::string words, message;
  } cases[] = {
      {"", "one ruleset, please"},
      {"none.rules", "cannot read 'none.rules'"},
      {chain + "--modules 0", "--modules 0 is outside"},
      {chain + "--worlds 3", "--worlds belongs to --measure"},
      {chain + "--gillespie 3", "--gillespie needs rates"},
      {chain + "--rates nowhere.csv", "nowhere.csv"},
      {chain + "--rates a --measure b", "--measure or --rates, not both"},
      {chain + "--measure nothing.toml", "nothing.toml"},
      {chain + "--measure pause.toml", "the scenario's [[command]] tables would have no effect"},
      {"pair.rules --measure '" + tank + "'",
       "rules.r1_reverse.p would have no effect: it is of the rules of chain5, and those of pair"},
      {"'" + kRulesets + "i4.rules' --measure '" + tank + "'", "and those of i4 are others"},
      {measured + "--set module.count=2000",
       "module.count 2000 is outside 1 .. 1000: give --modules"},
      {measured + "--set module.count=4 --modules 5",
       "--set module.count would have no effect: --modules decides"},
      {measured + "--set run.seed=3", "--set run.seed would have no effect: --seed decides"},
      {measured + "--set rules.r1_reverse.p=2", "rules.r1_reverse.p"},
  };
  for (const auto& c : cases) {
    const Answer a = lilytank("check " + c.words);
    EXPECT_EQ(a.code, 2) << c.words;
    EXPECT_NE(a.err.find(c.message), std::string::npos) << c.words << "\n" << a.err;
    EXPECT_EQ(a.out, "") << c.words << ": before any work";
  }
}

}  // namespace
}  // namespace lilytank
