// Options and files that a verb cannot do anything with: refused by name, with what would be right.
#include "cli/process.hpp"
#include "cli/refusals.hpp"

namespace lilytank {
namespace {

const std::string kDrops =
    "[experiment]\nbody = \"point\"\n[[recording]]\nfile = \"drops.csv\"\ntime = \"t\"\n"
    "x = \"y\"\n";

class OptionsTest : public RefusalTest {
 protected:
  OptionsTest() {
    lilytank_.here.write("drops.toml", kDrops);
    lilytank_.here.write("study.toml", "\n[study]\nscenario = \"pair.toml\"\n");
    lilytank_.here.write("search.toml", "[optimize]\nscenario = \"pair.toml\"\n");
    lilytank_.here.write("t.txt", "###\n");
  }
};

TEST_F(OptionsTest, ASwitchThatIsFalseIsOff) {
  ASSERT_EQ(lilytank_("run pair.toml --out a --quiet").code, 0);
  const Answer forced = lilytank_("run tiny.toml --out a --force=false");
  EXPECT_EQ(forced.code, 2);
  EXPECT_TRUE(forced.err.starts_with("'a' holds another run")) << forced.err;
  EXPECT_NE(lilytank_("run pair.toml --out a --quiet=false").err, "");
  EXPECT_EQ(lilytank_("run pair.toml --out a --quiet=true").err, "");
  EXPECT_EQ(lilytank_("run tiny.toml --out b --dry-run=false --quiet").code, 0);
  EXPECT_TRUE(lilytank_.here.has("b/summary.txt"));
  EXPECT_EQ(lilytank_("run tiny.toml --out a --force=true --quiet").code, 0);
  refused("run tiny.toml --quiet=banana", "lilytank run: --quiet is true or false, not 'banana'");
  refused("run tiny.toml --force=", "lilytank run: --force is true or false, not ''");
}

TEST_F(OptionsTest, WithoutEffectTheyAreRefused) {
  const std::string bodies = " has no effect on an experiment of point bodies";
  refused("diagnose drops.toml --set x=y", "lilytank diagnose: --set" + bodies);
  refused("diagnose drops.toml --hold-out 7", "lilytank diagnose: --hold-out" + bodies);
  refused("calibrate tiny.toml --duration 1min",
          "lilytank calibrate: --duration goes with --recover");
  refused("calibrate tiny.toml --recordings 7",
          "lilytank calibrate: --recordings goes with --recover");
  refused("calibrate tiny.toml --recover 1 --start x.toml",
          "lilytank calibrate: --start has no effect with --recover");
  refused("calibrate tiny.toml --recover 1 --balls 3",
          "lilytank calibrate: --balls has no effect with --recover");
  refused("calibrate tiny.toml --recover 1 --flow paper",
          "lilytank calibrate: --flow paper does not go with --recover: smooth or scenario");
  refused("synthesize t.txt --all D --out q",
          "lilytank synthesize: --out is of one plan; --all writes all into its directory");
  refused("synthesize t.txt --all D --algorithm balanced",
          "lilytank synthesize: --algorithm chooses a plan, and --all makes all of them");
  const std::string rates = " needs rates: --measure SCENARIO or --rates RUN";
  refused("check pair.rules --duration '5 min'", "lilytank check: --duration" + rates);
  refused("check pair.rules --out o", "lilytank check: --out" + rates);
  refused("check pair.rules --measure pair.toml --duration 5m",
          "lilytank check: --duration is a time in s; 'm' is not");
  refused("check pair.rules --measure pair.toml --duration=-5",
          "lilytank check: --duration -5 is outside 1 .. 1e+09 s");
}

TEST_F(OptionsTest, TimesArePlainSecondsOrHaveAUnit) {
  const std::string check =
      "check pair.rules --modules 4 --lattice 0 --measure pair.toml --worlds 1 --gillespie 2 ";
  const Answer plain = lilytank_(check + "--duration 120 --out a --quiet");
  const Answer unit = lilytank_(check + "--duration '2 min' --out b --quiet");
  EXPECT_EQ(plain.code, 0) << plain.err;
  const auto results = [](const std::string& out) {
    return out.substr(0, out.find("\nProvenance"));
  };
  EXPECT_EQ(results(plain.out), results(unit.out));
  for (const char* file : {"rates.csv", "yield.csv"}) {
    EXPECT_EQ(lilytank_.files("a").at(file), lilytank_.files("b").at(file)) << file;
  }
  refused(
      "run tiny.toml --set tank.radius=.3",
      "--set tank.radius=.3: tank.radius = \".3\" has no unit - write 0.3 without quotes for SI "
      "units, or name the unit");
}

TEST_F(OptionsTest, FilesOfOtherVerbsAreCalledWhatTheyAre) {
  for (const char* verb : {"run", "info", "flow", "analyze", "calibrate", "recording info",
                           "recording convert --out o", "diagnose tiny.toml"}) {
    refused(std::string(verb) + " drops.toml",
            "drops.toml:2:8: this is an experiment of point bodies: for lilytank diagnose, one at "
            "a time");
  }
  for (const char* verb : {"run", "info", "calibrate"}) {
    refused(std::string(verb) + " study.toml",
            "study.toml:2:2: [study] is not of a scenario, but of the file of a study: for "
            "lilytank study");
    refused(std::string(verb) + " search.toml",
            "search.toml:1:2: [optimize] is not of a scenario, but of the file of an optimisation: "
            "for lilytank optimize");
  }
}

TEST_F(OptionsTest, AMisspeltBodyIsWhatIsTold) {
  const std::string rest = "[baseline]\ngravity = 9.81\n[[recording]]\nfile = \"p.csv\"\n";
  lilytank_.here.write("p.toml", "[experiment]\nbody = \"pont\"\n" + rest);
  lilytank_.here.write("q.toml", "[experiment]\n" + rest);
  refused("diagnose p.toml",
          "p.toml:2:8: experiment.body = \"pont\" is none of lily, ball, point - did you mean "
          "'point'?");
  refused("diagnose q.toml",
          "q.toml:2:1: [baseline] is of point bodies: say body = \"point\" in [experiment]");
}

// Recordings of a tank may be of points, too.
TEST_F(OptionsTest, PointsInATankAreNotRefused) {
  lilytank_.here.write("p.csv", "frame,time,id,x,y\n0,0,0,0,0\n1,0.1,0,0.001,0\n");
  lilytank_.here.write("p.toml",
                       "[experiment]\nbody = \"point\"\n[[recording]]\nfile = \"p.csv\"\n");
  const Answer a = lilytank_("recording info p.toml");
  EXPECT_EQ(a.code, 0) << a.err;
}

TEST_F(OptionsTest, HelpOfHelpIsHelp) {
  const Answer a = lilytank_("help help");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_EQ(a.out, lilytank_("help").out);
  EXPECT_EQ(lilytank_("help --help").out, a.out);
}

TEST_F(OptionsTest, AnInterruptedCheckDoesNotPromiseWhatIsNotKept) {
  Process check(lilytank_.here.path(),
                {"check", LILYTANK_SOURCE_DIR "/scenarios/rulesets/caterpillar7.rules", "--lattice",
                 "100000", "--quiet"},
                "said");
  check.await([&] { return check.catches(SIGINT); });
  EXPECT_EQ(check.end(SIGINT), 3);
  EXPECT_EQ(lilytank_.here.read("said"),
            "stopped; lattice simulations are not kept, so the same command starts again\n");
}

}  // namespace
}  // namespace lilytank
