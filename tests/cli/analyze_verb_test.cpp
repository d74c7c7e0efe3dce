// lilytank analyze on runs, recordings and experiments.
#include <gtest/gtest.h>

#include <cmath>

#include "cli/program.hpp"

namespace lilytank {
namespace {

// Three balls that go round for four seconds, as a tidy recording.
std::string orbits(double pace) {
  std::string text = "frame,time,id,x,y\n";
  for (int f = 0; f < 120; ++f) {
    for (int b = 0; b < 3; ++b) {
      const double a = pace * f / 30.0 + 2.1 * b, r = 0.1 + 0.02 * b;
      char row[120];
      std::snprintf(row, sizeof row, "%d,%.4f,%d,%.5f,%.5f\n", f, f / 30.0, b, r * std::cos(a),
                    r * std::sin(a));
      text += row;
    }
  }
  return text;
}

class AnalyzeVerb : public testing::Test {
 protected:
  AnalyzeVerb() {
    lilytank_.here.write("slow.csv", orbits(1.5));
    lilytank_.here.write("fast.csv", orbits(2.5));
    lilytank_.here.write("tiny.toml", kTiny);
  }
  bool has(const std::string& file) const { return lilytank_.here.has(file); }
  Program lilytank_;
};

TEST_F(AnalyzeVerb, TellsOfARecording) {
  const Answer a = lilytank_("analyze slow.csv --body ball --out o");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("Mean squared displacement"), std::string::npos);
  const std::string circulation = "circulation (rad/s)";
  ASSERT_NE(a.out.find(circulation), std::string::npos) << a.out;
  EXPECT_NEAR(std::stod(a.out.substr(a.out.find(circulation) + circulation.size())), 1.5, 0.01);
  EXPECT_EQ(a.out, lilytank_.here.read("o/summary.txt"));
  for (const char* name : {"msd_all.csv", "velocity_map.csv", "contact_times.csv", "summary.csv"}) {
    EXPECT_TRUE(has(std::string("o/") + name)) << name;
  }
#ifdef LILYTANK_HAS_RENDER
  for (const char* name : {"msd_all.png", "msd_all_log.svg", "velocity_map.png", "transfer.svg"}) {
    EXPECT_TRUE(has(std::string("o/") + name)) << name;
  }
#endif
}

TEST_F(AnalyzeVerb, LaysTwoSourcesOverEachOther) {
  const Answer a =
      lilytank_("analyze slow.csv fast.csv --body ball --name real --name model --out o");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("model less real"), std::string::npos) << a.out;
  EXPECT_NE(lilytank_.here.read("o/msd_all.csv").find("\ndifference,"), std::string::npos);
}

TEST_F(AnalyzeVerb, IsTheSameEveryTime) {
  ASSERT_EQ(lilytank_("analyze slow.csv fast.csv --body ball --out a").code, 0);
  ASSERT_EQ(lilytank_("analyze slow.csv fast.csv --body ball --out b").code, 0);
  EXPECT_EQ(lilytank_.files("a"), lilytank_.files("b"));
}

TEST_F(AnalyzeVerb, TakesPartOfTheTime) {
  const Answer a = lilytank_("analyze slow.csv --body ball --from 1 --to '2 s' --out o --msd-only");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("duration (s)      1.00"), std::string::npos) << a.out;
  EXPECT_EQ(lilytank_("analyze slow.csv --body ball --from 1 --to 1 --out o").code, 2);
  const Answer late = lilytank_("analyze slow.csv --body ball --from 100 --out o2");
  EXPECT_EQ(late.code, 2);
  EXPECT_NE(late.err.find("shows no body"), std::string::npos) << late.err;
}

TEST_F(AnalyzeVerb, NamesRunsByAKeyAndTakesReplicatesTogether) {
  for (const char* run :
       {"p50a --set flow.pump_power=50 --seed 1", "p50b --set flow.pump_power=50 --seed 2",
        "p80 --set flow.pump_power=80 --seed 1"}) {
    ASSERT_EQ(
        lilytank_("run tiny.toml --quiet --set output.rate=40 --out " + std::string(run)).code, 0);
  }
  const Answer a = lilytank_("analyze p50a p50b p80 --label flow.pump_power --msd-only --out o");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("50 %"), std::string::npos);
  EXPECT_NE(a.out.find("80 % less 50 %"), std::string::npos) << a.out;
  const std::string summary = lilytank_.here.read("o/summary.csv");
  EXPECT_NE(summary.find("50 %,recordings,1,2,"), std::string::npos) << summary;
  const Answer many = lilytank_(
      "analyze p50a p80 --label flow.water_level --panel flow.pump_power --msd-only --out o3");
  EXPECT_EQ(many.code, 0) << many.err;
  EXPECT_NE(many.out.find("-8 cm"), std::string::npos) << many.out;
#ifdef LILYTANK_HAS_RENDER
  EXPECT_TRUE(has("o3/msd_all.svg"));
#endif
  const Answer wrong = lilytank_("analyze p80 --label flow.pump_powr --out o2");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("did you mean 'flow.pump_power'"), std::string::npos) << wrong.err;
}

TEST_F(AnalyzeVerb, ReadsExperimentsByKindOfBody) {
  lilytank_.here.write("e.toml",
                       "[experiment]\nname = \"two kinds\"\n"
                       "[[recording]]\nfile = \"slow.csv\"\nbody = \"ball\"\n"
                       "[[recording]]\nfile = \"fast.csv\"\nbody = \"lily\"\n");
  const Answer both = lilytank_("analyze e.toml --msd-only --out o");
  EXPECT_EQ(both.code, 0) << both.err;
  EXPECT_NE(both.out.find("two kinds balls"), std::string::npos) << both.out;
  EXPECT_NE(both.out.find("two kinds modules"), std::string::npos) << both.out;
  const Answer balls = lilytank_("analyze e.toml --body ball --msd-only --out o2");
  EXPECT_EQ(balls.out.find("modules"), std::string::npos) << balls.out;
}

TEST_F(AnalyzeVerb, RefusesWhatItCannotRead) {
  for (const char* words :
       {"", "nothing.csv", "nothing.toml", "slow.csv --body fish", "slow.csv --window 0",
        "slow.csv --degree 3", "slow.csv --window 1 --degree 9", "slow.csv --name a --name b",
        "slow.csv --diffusion-from 1"}) {
    const Answer a = lilytank_("analyze --out o " + std::string(words));
    EXPECT_EQ(a.code, 2) << words;
    EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
    EXPECT_FALSE(has("o")) << words;
  }
}

TEST_F(AnalyzeVerb, DryRunReadsEverythingAndWritesNothing) {
  const auto before = lilytank_.names();
  const Answer a = lilytank_("analyze " + kTank + " --body lily --dry-run --out a");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_TRUE(a.out.starts_with("would analyze 1 source; in a\n")) << a.out;
  EXPECT_NE(a.out.find("2 recordings, 30"), std::string::npos) << a.out;
  EXPECT_EQ(lilytank_.names(), before);
}

}  // namespace
}  // namespace lilytank
