// lilytank flow: what users see.
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/program.hpp"
#include "lilytank/flow_field.hpp"
#include "lilytank/recording_io.hpp"

namespace lilytank {
namespace {

TEST(flowVerb, leavesGridsThatARunReads) {
  const Program lilytank;
  Answer a = lilytank("flow " + kTank + " --out f");
  ASSERT_EQ(a.code, 0) << a.err;
  for (const char* text :
       {"Flow of tank: the balls measured", "measured cells", "median standard error of a mean",
        "tracking noise", "false-discovery rate"}) {
    EXPECT_NE(a.out.find(text), std::string::npos) << text << "\n" << a.out;
  }
  // Twenty seconds are little for 50 x 50 cells, and that is said.
  EXPECT_NE(a.out.find("measured cells, of 1976 in the tank"), std::string::npos) << a.out;
  EXPECT_NE(a.out.find("smooth measured 6 of 1976 cells of the tank"), std::string::npos) << a.out;
  EXPECT_EQ(lilytank.here.read("f/flow.txt"), a.out);
  for (const char* name : {"paper", "smooth"}) {
    const std::string n = name;
    EXPECT_NO_THROW(
        read_flow_csv(lilytank.here.path("f/flow_" + n + ".csv"), Interpolation::nearest));
    EXPECT_NE(lilytank.here.read("f/cells_" + n + ".csv").find("std_vy_se"), std::string::npos);
#ifdef LILYTANK_HAS_RENDER
    EXPECT_GT(lilytank.here.read("f/flow_" + n + ".png").size(), 10000u);
    EXPECT_GT(lilytank.here.read("f/flow_" + n + ".svg").size(), 10000u);
#endif
  }
#ifdef LILYTANK_HAS_RENDER
  EXPECT_NE(lilytank.here.read("f/report.html").find("Flow of tank"), std::string::npos);
#endif
  a = lilytank("run '" LILYTANK_SOURCE_DIR
               "/scenarios/tank_balls.toml' f/balls_smooth.toml "
               "--set run.duration='2 s' --out r --quiet");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_NE(lilytank.here.read("r/resolved.toml").find("C = 0.47"), std::string::npos);
}

TEST(flowVerb, aTruthGivesErrors) {
  const Program lilytank;
  ASSERT_EQ(lilytank("flow " + kTank + " --estimator paper --out p").code, 0);
  const Answer a =
      lilytank("flow " + kTank + " --estimator smooth --truth p/flow_paper.csv --out s");
  ASSERT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("Errors against p/flow_paper.csv"), std::string::npos) << a.out;
  EXPECT_EQ(a.out.find("false-discovery rate"), std::string::npos);
  EXPECT_EQ(lilytank.here.read("s/errors_smooth.csv").substr(0, 6), "ix,iy,");
}

TEST(flowVerb, replacesOnlyWhatAFlowLeft) {
  const Program lilytank;
  const std::string flow = "flow " + kTank + " --estimator paper --out f --quiet";
  std::filesystem::create_directory(lilytank.here.path("f"));
  lilytank.here.write("f/flow.txt", "mine");
  Answer a = lilytank(flow);
  EXPECT_EQ(a.code, 2);
  EXPECT_NE(a.err.find("'f' holds a file 'flow.txt' that is not of a flow"), std::string::npos)
      << a.err;
  EXPECT_EQ(lilytank.here.read("f/flow.txt"), "mine");
  EXPECT_EQ(lilytank(flow + " --force").code, 0);
  EXPECT_EQ(lilytank(flow).code, 0);
  a = lilytank(flow + " --cells 20");
  EXPECT_EQ(a.code, 2);
  EXPECT_NE(a.err.find("'f' holds another flow (other data, options or program)"),
            std::string::npos)
      << a.err;
}

// But twenty seconds of balls do not tell the gusts, whatever the cells.
TEST(flowVerb, largeCellsAreMeasured) {
  const Program lilytank;
  const Answer a = lilytank("flow " + kTank + " --cells 10 --out f");
  ASSERT_EQ(a.code, 0) << a.err;
  EXPECT_EQ(a.out.find("filled all others"), std::string::npos) << a.out;
  EXPECT_NE(a.out.find("standard error of the gusts' standard deviation: "), std::string::npos)
      << a.out;
}

// Of some variants this recording is too short for; the others are told all the same.
TEST(flowVerb, biasGoesOnWhereARecordingIsTooShort) {
  const Program lilytank;
  Recording balls = read_recording(LILYTANK_SOURCE_DIR "/scenarios/experiments/balls_1.csv.gz");
  balls.frames = 80;
  for (Track& t : balls.tracks) t.x.resize(80), t.y.resize(80);
  write_recording(balls, lilytank.here.path("short.csv"), RecordingFormat::tidy);
  lilytank.here.write("short.toml", "[[recording]]\nfile = \"short.csv\"\nbody = \"ball\"\n");
  const Answer a = lilytank("flow short.toml --bias --cells 12 --out f --quiet");
  ASSERT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("no random force, smooth: the balls' tracks hold"), std::string::npos)
      << a.out;
  const std::string table = lilytank.here.read("f/bias.csv");
  EXPECT_NE(table.find("\nno random force,smooth,0,,,,,,,\n"), std::string::npos) << table;
  EXPECT_NE(table.find("\nrandom force x 2,smooth,"), std::string::npos) << table;
  EXPECT_EQ(lilytank.here.read("f/flow.txt"), a.out);
  EXPECT_TRUE(lilytank.here.has("f/flow_smooth.csv"));
}

TEST(flowVerb, refusesWithOneLine) {
  const Program lilytank;
  lilytank.here.write("lilies.toml", "[[recording]]\nfile = \"l.csv\"\nbody = \"lily\"\n");
  lilytank.here.write("l.csv", "frame,time,id,x,y\n0,0,0,0,0\n1,0.1,0,0,0\n");
  lilytank.here.write("bad.csv", "ix,iy\n");
  const struct {
    std::string words, message;
  } cases[] = {
      {"", "of what? write lilytank flow EXPERIMENT.toml"},
      {kTank + " --estimator papr", "did you mean 'paper'?"},
      {kTank + " --truth none.csv", "cannot read 'none.csv'"},
      {kTank + " --truth bad.csv", "bad.csv:1:1: the first line is not"},
      {kTank + " --cells 1", "cells"},
      {kTank + " --kalman --degree 3", "--kalman has neither"},
      {kTank + " --bias --estimator paper", "--bias needs --estimator smooth or both"},
      {"lilies.toml", "no recording that may be used is of body = \"ball\""},
  };
  for (const auto& c : cases) {
    const Answer a = lilytank("flow " + c.words);
    EXPECT_EQ(a.code, 2) << c.words;
    EXPECT_NE(a.err.find(c.message), std::string::npos) << c.words << "\n" << a.err;
  }
}

TEST(flowVerb, dryRunSaysWhatWouldBeDoneAndWritesNothing) {
  const Program lilytank;
  const Answer a = lilytank("flow " + kTank + " --cells 20 --bias --dry-run --out f");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_EQ(a.out,
            "would estimate the flow of tank from 1 recording of balls (20 s) on 20 x 20 cells, "
            "estimator both, with errors on synthetic recordings; in f\n");
  EXPECT_TRUE(lilytank.names().empty());
}

}  // namespace
}  // namespace lilytank
