// A file '-' is standard input.
#include <gtest/gtest.h>

#include "cli/program.hpp"

namespace lilytank {
namespace {

class StandardInput : public testing::Test {
 protected:
  StandardInput() { lilytank_.here.write("tiny.toml", kTiny); }
  /// Runs the program with a text as its standard input.
  Answer piped(const std::string& text, const std::string& arguments) {
    lilytank_.here.write("piped", text);
    lilytank_.input = "piped";
    Answer answer = lilytank_(arguments);
    lilytank_.input = "/dev/null";
    return answer;
  }
  void refused(const std::string& text, const std::string& arguments, const std::string& message) {
    const Answer answer = piped(text, arguments);
    EXPECT_EQ(answer.code, 2) << arguments;
    EXPECT_EQ(answer.err, message + "\n") << arguments;
    EXPECT_EQ(answer.out, "") << arguments;
  }
  Program lilytank_;
};

TEST_F(StandardInput, ARunIsThatOfTheFile) {
  ASSERT_EQ(lilytank_("run tiny.toml --quiet --out file").code, 0);
  const Answer run = piped(kTiny, "run - --quiet --out piped_run");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto files = lilytank_.files("file"), piped_files = lilytank_.files("piped_run");
  EXPECT_EQ(files.at("resolved.toml"), piped_files.at("resolved.toml"));
  EXPECT_EQ(files.at("trajectory.bin"), piped_files.at("trajectory.bin"));
  EXPECT_EQ(piped(kTiny, "run - --quiet --out piped_run").code, 0) << "complete already";
  const Answer other = piped(kTiny + "count = 5\n", "run - --quiet --out piped_run");
  EXPECT_EQ(other.code, 2) << other.out;
}

TEST_F(StandardInput, MessagesNameItWithThePlace) {
  const std::string message =
      "<stdin>:3:10: tank.radius = 300 m is outside 0.05 .. 5 m - if this is in mm, write \"300 "
      "mm\"";
  refused("[tank]\n\nradius = 300\n", "run -", message);
  refused("[tank]\n\nradius = 300\n", "run tiny.toml -", message);
  refused(
      "lilytank ruleset 1\nnome x\n", "check -",
      "<stdin>:2:1: 'nome' is not known here: expected 'name', 'hops', 'target' or a rule - did "
      "you mean 'name'?");
  refused("", "recording info -", "<stdin>:1:1: there is no table in it");
  refused(kTiny, "render -", "'<stdin>' is not the directory of a run: it has no resolved.toml");
}

TEST_F(StandardInput, IsNamedOnce) {
  refused(kTiny, "run - -",
          "lilytank run: standard input is read once: write '-' for one file only");
  const Answer file = piped(kTiny, "run -- -");
  EXPECT_EQ(file.code, 2) << "behind -- it is a file";
  EXPECT_NE(file.err.find("cannot read '-'"), std::string::npos) << file.err;
}

TEST_F(StandardInput, PathsStartFromTheWorkingDirectory) {
  lilytank_.here.write("rules/pair.rules", kPairRules);
  const Answer info = piped("ruleset.file = \"rules/pair.rules\"\n", "info -");
  EXPECT_EQ(info.code, 0) << info.err;
  refused("ruleset.file = \"pair.rules\"\n", "info -",
          "<stdin>:1:16: cannot read 'pair.rules': No such file or directory");
}

TEST_F(StandardInput, RecordingsAndExperimentsAreDistinguished) {
  lilytank_.here.write("r.csv", "frame,time,id,x,y\n0,0,0,0,0\n1,0.1,0,0.001,0\n");
  const Answer table = piped(lilytank_.here.read("r.csv"), "recording info -");
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_TRUE(table.out.starts_with("<stdin>\n")) << table.out;
  const Answer experiment =
      piped("# mine\n\n[[recording]]\nfile = \"r.csv\"\n", "recording info -");
  EXPECT_EQ(experiment.code, 0) << experiment.err;
  EXPECT_TRUE(experiment.out.starts_with("r.csv\n")) << experiment.out;
  EXPECT_EQ(piped(lilytank_.here.read("r.csv"), "analyze - --msd-only --out .").code, 0);
}

TEST_F(StandardInput, ReportsNameItWithItsHash) {
  const Answer check = piped(kPairRules, "check - --modules 4 --lattice 0");
  EXPECT_NE(check.out.find("  <stdin>\n"), std::string::npos) << check.out;
  const Answer slurm = piped(kTiny, "study slurm -");
  EXPECT_EQ(slurm.code, 2) << slurm.out;
}

}  // namespace
}  // namespace lilytank
