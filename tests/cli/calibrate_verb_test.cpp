// lilytank calibrate: what users see. Few and short simulations: nothing here is about the answer.
#include <gtest/gtest.h>
#include <signal.h>

#include "cli/process.hpp"
#include "cli/program.hpp"

namespace lilytank {
namespace {

std::string words(const std::vector<std::string>& of) {
  std::string out;
  for (const std::string& word : of) out += "'" + word + "' ";
  return out;
}

// The shipped experiment, with 8 s and 4 s of its Lilies.
class calibrateVerb : public testing::Test {
 protected:
  calibrateVerb() {
    const std::string cut = "cd '" LILYTANK_SOURCE_DIR
                            "/scenarios/experiments' && cut() { zcat $1 | head -n $2 > '" +
                            short_.path() +
                            "'/${1%.gz}; }; cut balls_1.csv.gz 99999; cut lily_1.csv.gz 3601; "
                            "cut lily_2.csv.gz 1801; sed s/csv.gz/csv/ tank.toml > '" +
                            short_.path("tank.toml") + "'";
    EXPECT_EQ(std::system(cut.c_str()), 0);
  }

  const TemporaryDirectory short_;
  std::vector<std::string> few_{"calibrate",     short_.path("tank.toml"),
                                "--evaluations", "40",
                                "--simulations", "40",
                                "--replicates",  "20",
                                "--comparisons", "3",
                                "--flow-draws",  "2"};
  const Program lilytank;
};

TEST_F(calibrateVerb, leavesAReportAndAnOverlayThatRunTakes) {
  Answer a = lilytank(words(few_) + "--out c");
  ASSERT_EQ(a.code, 0) << a.err;
  for (const char* text : {"Calibration of tank", "flow.K_v", "forces.damping.D_angular",
                           "training", "held out", "noise floor", "Misfit"}) {
    EXPECT_NE(a.out.find(text), std::string::npos) << text << "\n" << a.out;
  }
  EXPECT_EQ(lilytank.here.read("c/calibration.txt"), a.out);
  for (const char* name : {"intervals.csv", "correlation.csv", "profiles.csv", "numbers.csv",
                           "history.csv", "msd.csv", "velocity.csv", "calibration.json"}) {
    EXPECT_GT(lilytank.here.read(std::string("c/") + name).size(), 50u) << name;
  }
#ifdef LILYTANK_HAS_RENDER
  for (const char* name : {"convergence", "msd", "velocity", "profiles", "estimates"}) {
    EXPECT_GT(lilytank.here.read(std::string("c/") + name + ".png").size(), 5000u) << name;
    EXPECT_GT(lilytank.here.read(std::string("c/") + name + ".svg").size(), 2000u) << name;
  }
#endif
  // K_F holds for the immersion depth of the experiment only, which is not the scenario's.
  EXPECT_NE(lilytank.here.read("c/calibrated.toml").find("module.draught = 0.025\n"),
            std::string::npos);
  a = lilytank("run '" LILYTANK_SOURCE_DIR
               "/scenarios/tank_lilies.toml' c/calibrated.toml "
               "--set run.duration='1 s' --out r --quiet");
  EXPECT_EQ(a.code, 0) << a.err;
  // Again: nothing is left to do, and the answer is the same.
  a = lilytank(words(few_) + "--out c");
  EXPECT_EQ(lilytank.here.read("c/calibration.txt"), a.out);
}

TEST_F(calibrateVerb, dryRunSaysWhatWouldBeDoneAndWritesNothing) {
  const Answer a = lilytank(words(few_) + "--dry-run --out c");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_TRUE(
      a.out.starts_with("would calibrate tank: 1 recording of up to 15 bodies; 2 extractions"))
      << a.out;
  EXPECT_NE(a.out.find("of processor time; in c\n"), std::string::npos) << a.out;
  EXPECT_TRUE(lilytank.names().empty());
  lilytank.here.write("c/calibration.txt", "mine");
  EXPECT_EQ(lilytank(words(few_) + "--dry-run --out c").code, 2);
}

// calibrated.toml of another experiment has that one's modules, which are not those of this one.
TEST_F(calibrateVerb, startsFromTheParametersOfAFileAlone) {
  lilytank.here.write("other.toml", "module.draught = 0.03\nflow.K_v = 1.25\n");
  const Answer a = lilytank(words(few_) + "--flow scenario --start other.toml --out c");
  ASSERT_EQ(a.code, 0) << a.err;
  EXPECT_NE(lilytank.here.read("c/calibrated.toml").find("module.draught = 0.025\n"),
            std::string::npos);
  EXPECT_NE(lilytank.here.read("c/intervals.csv").find(",1.25,"), std::string::npos);
}

TEST_F(calibrateVerb, killedAtAnyMomentTheSameCommandEndsInTheSameFiles) {
  auto quick = few_;
  quick.insert(quick.end(), {"--hold-out", "0", "--quiet"});
  ASSERT_EQ(lilytank(words(quick) + "--out whole").code, 0);
  quick.insert(quick.end(), {"--out", "parts"});
  const auto size = [&](const std::string& file) {
    std::error_code gone;
    const auto n = std::filesystem::file_size(lilytank.here.path(file), gone);
    return gone ? 0 : n;
  };
  // In every stage, as soon as something of it is there, and once before.
  for (const char* file : {"", "flow errors.rows", "search/evaluations.csv", "local model 1.rows",
                           "replicates.rows", "comparison after, training.rows"}) {
    Process process(lilytank.here.path(), quick);
    process.await([&] { return size(std::string("parts/work/") + file) > 100; });
    process.end(SIGKILL);
  }
  ASSERT_EQ(lilytank(words(quick)).code, 0);
  const auto whole = lilytank.files("whole"), parts = lilytank.files("parts");
  for (const auto& [name, content] : whole) {
    // Rows are kept in the order in which they were done.
    if (name.ends_with(".rows")) continue;
    ASSERT_TRUE(parts.count(name)) << name;
    EXPECT_EQ(parts.at(name), content) << name;
  }
}

TEST_F(calibrateVerb, asWellOfBallsAndByThePapersObjective) {
  Answer a = lilytank(words(few_) + "--balls --out b --quiet");
  ASSERT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("forces.ball_drag.C"), std::string::npos) << a.out;
  EXPECT_EQ(a.out.find("D_angular"), std::string::npos) << a.out;
  a = lilytank(words(few_) + "--objective msd --flow scenario --out m --quiet");
  ASSERT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("objective msd, flow scenario"), std::string::npos) << a.out;
}

TEST_F(calibrateVerb, refusesWithOneLine) {
  lilytank.here.write("balls.toml", "[[recording]]\nfile = \"l.csv\"\nbody = \"ball\"\n");
  lilytank.here.write("l.csv", "frame,time,id,x,y\n0,0,0,0,0\n1,0.1,0,0,0\n");
  const struct {
    std::string words, message;
  } cases[] = {
      {"", "of what? write lilytank calibrate EXPERIMENT.toml"},
      {kTank + " --objective sumary", "did you mean 'summary'?"},
      {kTank + " --objective prediction --vary module.draught=0.02..0.04", ": use summary"},
      {kTank + " --flow smoth", "did you mean 'smooth'?"},
      {kTank + " --search paper-lily", "did you mean 'paper-lilies'?"},
      {kTank + " --vary forces.face_drag.K_f=0.1..1", "did you mean 'forces.face_drag.K_F'?"},
      {kTank + " --vary flow.K_v", "is not of the form PATH=LOW..HIGH"},
      {kTank + " --vary flow.K_v=2..1", "the range must rise and lie within 0 .. 10"},
      {"balls.toml", "has no recording of body = \"lily\" that is not held out"},
      {kTank + " --hold-out 9", "there is nothing to calibrate from"},
  };
  for (const auto& c : cases) {
    const Answer a = lilytank("calibrate " + c.words + " --out x");
    EXPECT_EQ(a.code, 2) << c.words;
    EXPECT_NE(a.err.find(c.message), std::string::npos) << c.words << "\n" << a.err;
    EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
    EXPECT_FALSE(lilytank.here.has("x")) << c.words;
  }
}

TEST_F(calibrateVerb, aDirectoryOfAnotherCalibrationIsKept) {
  const std::string quick = words(few_) + "--flow scenario --out c --quiet";
  ASSERT_EQ(lilytank(quick).code, 0);
  const auto before = lilytank.files("c");
  const Answer a = lilytank(quick + " --seed 2");
  EXPECT_EQ(a.code, 2);
  EXPECT_NE(a.err.find("holds another calibration"), std::string::npos) << a.err;
  EXPECT_EQ(lilytank.files("c"), before);
  EXPECT_EQ(lilytank(quick + " --seed 2 --force").code, 0);
}

TEST_F(calibrateVerb, recoverTellsWhetherIntervalsHoldTheTruth) {
  lilytank.here.write("s.toml", "title = \"s\"\n[module]\ncount = 6\ndraught = 0.025\n");
  const Answer a = lilytank(
      "calibrate s.toml --recover 1 --recordings 1 --duration '20 s' --evaluations 40 "
      "--simulations 40 --replicates 20 --objective summary --out c --quiet");
  ASSERT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("flow.K_v"), std::string::npos) << a.out;
  EXPECT_EQ(lilytank.here.read("c/recovery.txt"), a.out);
  EXPECT_NE(lilytank.here.read("c/recovery.csv").find("1,summary,flow.K_v,"), std::string::npos);
}

}  // namespace
}  // namespace lilytank
