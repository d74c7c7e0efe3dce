// lilytank diagnose and prove from outside: what they refuse, and how.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/program.hpp"

namespace lilytank {
namespace {

TEST(diagnoseVerb, refusesWithOneLine) {
  const Program lilytank;
  lilytank.here.write("latched.toml",
                      "[[recording]]\nfile = \"l.csv\"\nbody = \"lily\"\nlatches = \"on\"\n");
  lilytank.here.write("balls.toml", "[[recording]]\nfile = \"b.csv\"\nbody = \"ball\"\n");
  lilytank.here.write("l.csv", "frame,time,id,x,y,theta\n0,0,0,0,0,0\n1,0.1,0,0,0,0\n");
  lilytank.here.write("b.csv", "frame,time,id,x,y\n0,0,0,0,0\n1,0.1,0,0,0\n");
  const struct {
    std::string words, message;
  } cases[] = {
      {"diagnose", "of what? write lilytank diagnose EXPERIMENT.toml"},
      {"diagnose nowhere.toml", "nowhere.toml"},
      {"diagnose latched.toml", "was recorded with latches on: name the modules' rules by"},
      {"diagnose balls.toml", "has no recording of body = \"lily\" that is not held out"},
      {"diagnose " + kTank + " --budget none", "--budget"},
      {"prove nowhere --worlds 3", "--worlds is for a new proof"},
      {"prove nowhere", "nowhere holds no finished proof: there is no key.txt"},
      {"prove --worlds 0", "--worlds"},
      {"prove --only nothing", "--only nothing is none of null, named, two, unnamed"},
      {"prove --only unamed", "--only unamed is none of null, named, two, unnamed - did you mean"},
      {"prove --modules 1", "--modules 1 is outside 2 .. 100"},
      {"prove --cells lilies=4", "--cells goes with --grid"},
      {"prove --grid --minutes 4", "--minutes is an axis of the grid"},
      {"prove --grid --only null", "--only has no effect with --grid"},
      {"prove --grid --cells ball=4",
       "--cells 'ball' is none of balls, lilies, modules, budget - "
       "did you mean 'balls'?"},
      {"prove --grid --cells modules=2.5", "--cells modules: '2.5' is not a whole number"},
      {"prove --grid --known-flow --cells balls=4", "with --known-flow: no balls are recorded"},
      {"prove --event-log", "--event-log without --latches: nothing latches"},
      {"prove --latches nowhere.rules", "nowhere.rules"},
      {"prove --effect evaluation_rate", "'evaluation_rate' is no effect of this tank"},
      {"prove --effect pair_atraction --dry-run", "did you mean 'pair_attraction'?"},
      {"prove --latches nowhere.rules --dry-run", "nowhere.rules"},
      {"prove --grid --effect pair_attraction", "--effect has no effect with --grid"},
      {"prove --worlds 1 --only named", "none of the first 1 synthetic experiments is \"named\""},
  };
  for (const auto& c : cases) {
    const Answer a = lilytank(c.words + " --out x");
    EXPECT_EQ(a.code, 2) << c.words << "\n" << a.err;
    EXPECT_NE(a.err.find(c.message), std::string::npos) << c.words << "\n" << a.err;
    EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
    EXPECT_FALSE(lilytank.here.has("x")) << c.words;
  }
}

// Twenty seconds of balls do not measure the flow: that is the verdict, before anything is
// simulated.
TEST(diagnoseVerb, shortRecordingsAreInsufficient) {
  const Program lilytank;
  const Answer a = lilytank("diagnose " + kTank + " --out x");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_TRUE(
      a.out.starts_with("Diagnosis of tank: the recordings are insufficient for a diagnosis\n"))
      << a.out;
  EXPECT_NE(a.out.find("min more of 24 balls"), std::string::npos) << a.out;
  EXPECT_NE(a.out.find("min more of 15 Lilies"), std::string::npos) << a.out;
  const std::string json = lilytank.here.read("x/diagnosis.json");
  EXPECT_NE(json.find("\"verdict\": \"insufficient\""), std::string::npos) << json;
  EXPECT_NE(json.find("\"shortfalls\""), std::string::npos) << json;
  EXPECT_FALSE(lilytank.here.has("x/work/baseline, round 1.rows"));
  // What to record in addition is an experiment that can be simulated.
  const Answer run =
      lilytank("run " + kTank + " x/next_experiment.toml --set run.duration=1 --out r");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(lilytank.here.read("r/resolved.toml").find("count = 15"), std::string::npos);
  // Again, and with more in the same directory.
  EXPECT_EQ(lilytank("diagnose " + kTank + " --out x").out, a.out);
}

// The refused directory stays free for the corrected command.
TEST(diagnoseVerb, refusesResultsOfAnotherTankWithoutATrace) {
  const Program lilytank;
  EXPECT_EQ(lilytank("diagnose " + kTank + " --out x").code, 0);
  const std::string again = "diagnose " + kTank + " --tank " + kTank + " --tank-results x --out y";
  const Answer other = lilytank(again + " --seed 4");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("'x' is not of a diagnosis of tank with the same --seed"),
            std::string::npos)
      << other.err;
  EXPECT_FALSE(lilytank.here.has("y"));
  EXPECT_EQ(lilytank(again).code, 0);
}

// Finished benchmarks, summarised alone and pooled.
TEST(proveVerb, tellsFinishedProofsAsAReport) {
  const Program lilytank;
  const std::string seed16 = std::string(LILYTANK_SOURCE_DIR) + "/tests/data/proofs/seed16";
  const Answer said = lilytank("prove " + seed16);
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_TRUE(
      said.out.starts_with("Blinded synthetic benchmark: 80 of 80 experiments diagnosed, in the "
                           "built-in tank of seed 16"))
      << said.out;
  const Answer report = lilytank("prove " + seed16 + " --out r");
  EXPECT_EQ(report.code, 0) << report.err;
  EXPECT_EQ(report.out, said.out);
  EXPECT_EQ(lilytank.here.read("r/proof.txt"), said.out);
  const Answer twice = lilytank("prove " + seed16 + " " + seed16 + " --out r");
  EXPECT_EQ(twice.code, 2);
  EXPECT_NE(twice.err.find("has the same key as"), std::string::npos) << twice.err;
  const std::string nulls15 = std::string(LILYTANK_SOURCE_DIR) + "/tests/data/proofs/nulls15";
  const Answer nulls = lilytank("prove " + seed16 + " " + nulls15);
  EXPECT_EQ(nulls.code, 0) << nulls.err;
  EXPECT_TRUE(
      nulls.out.starts_with("Blinded synthetic benchmark: 160 of 160 experiments diagnosed, in 2 "
                            "tanks or sets of balls\n"))
      << nulls.out;
#ifdef LILYTANK_HAS_RENDER
  const std::string page = lilytank.here.read("r/report.html");
  for (const char* part :
       {"Fraction of synthetic experiments", "Verdict on every experiment", "local_flow"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
#endif
}

TEST(diagnoseVerb, dryRunSaysWhatWouldBeDoneAndWritesNothing) {
  const Program lilytank;
  const Answer a = lilytank("diagnose " + kTank + " --budget 5 --dry-run --out d");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_EQ(a.out,
            "would diagnose tank: 2 recordings of Lilies, 1 held out: about 5 min on two cores; in "
            "d\n");
  EXPECT_NE(
      lilytank("diagnose " LILYTANK_SOURCE_DIR "/scenarios/experiments/real/gliders.toml --dry-run")
          .out.find("of point bodies: about 10 min on two cores; in out/diagnose-"),
      std::string::npos);
  EXPECT_EQ(lilytank("prove --worlds 3 --minutes 2 --dry-run --out p").out,
            "would simulate and diagnose 3 experiments of 3 recordings of 2 min; the tank's null "
            "experiments take about 10 min on two cores; in p\n");
  EXPECT_NE(lilytank("prove --worlds 3 --minutes 2 --budget 1 --dry-run").out.find("about 3 min"),
            std::string::npos);
  EXPECT_EQ(
      lilytank("prove --grid --worlds 3 --cells lilies=20s --cells balls=4min "
               "--cells modules=5,30 --cells budget=1 --seed 23 --dry-run --out g")
          .out,
      "would simulate 3 null experiments in each of 2 cells, and diagnose those that are "
      "sufficient; in g\n"
      "  lilytank prove --only null --worlds 12 --minutes 0.3333333333333333 --ball-minutes 4 "
      "--modules 5 --budget 1 --modelled 0 --seed 1708233250 --out "
      "g/balls-4min_lilies-20s_modules-5_budget-1\n"
      "  lilytank prove --only null --worlds 12 --minutes 0.3333333333333333 --ball-minutes 4 "
      "--modules 30 --budget 1 --modelled 0 --seed 1484882597 --out "
      "g/balls-4min_lilies-20s_modules-30_budget-1\n");
  EXPECT_TRUE(lilytank.names().empty());
  lilytank.here.write("d", "mine");
  EXPECT_EQ(lilytank("diagnose " + kTank + " --dry-run --out d").code, 2);
}

// Five Lilies for 3 x 20 s are too few whatever the budget: nothing is simulated for them, and one
// directory serves both budgets.
TEST(proveVerb, gridCountsInsufficientExperiments) {
  const Program lilytank;
  const std::string grid =
      "prove --grid --known-flow --cells lilies=20s --cells modules=5 --worlds 2 --quiet --out g";
  const Answer a = lilytank(grid);
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_TRUE(a.out.starts_with("False positives by the amount of data: 2 of 2 cells finished\n"))
      << a.out;
  const std::string csv = lilytank.here.read("g/grid.csv");
  EXPECT_NE(csv.find("\n,20,5,1,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",2,2,0,0,,,,,time of the Lilies,"), std::string::npos) << csv;
  EXPECT_TRUE(lilytank.here.has("g/known-flow_lilies-20s_modules-5_budget-1/key.txt"));
  EXPECT_FALSE(lilytank.here.has("g/known-flow_lilies-20s_modules-5_budget-10"));
  EXPECT_FALSE(
      lilytank.here.has("g/known-flow_lilies-20s_modules-5_budget-1/work/baseline, round 1.rows"));
  EXPECT_EQ(lilytank.here.read("g/grid.txt"), a.out);
  EXPECT_EQ(lilytank(grid).out, a.out);
  EXPECT_EQ(lilytank.here.read("g/grid.csv"), csv);
  EXPECT_NE(lilytank(grid + " --dry-run").out.find("# finished"), std::string::npos);
  const Answer other = lilytank(grid + " --seed 2");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("holds another grid"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace lilytank
