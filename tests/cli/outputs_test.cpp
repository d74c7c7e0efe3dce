// Where results go: what is read is spared, what is no file stays what it is, and what cannot be
// written is told.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/refusals.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

const std::string kTable =
    "frame,time,id,x,y\n0,0,0,0,0\n1,0.1,0,0.001,0\n2,0.2,0,0.002,0\n0,0,1,0.1,0\n1,0.1,1,0.1,0\n";
const std::string kSearch =
    "[optimize]\nscenario = \"pair.toml\"\nevaluations = 12\npopulation = 4\n"
    "final_evaluations = 4\n[[parameter]]\npath = \"rules.part.p\"\nlow = 0.001\nhigh = 1\n";

class OutputsTest : public RefusalTest {
 protected:
  OutputsTest() {
    lilytank_.here.write("a.csv", kTable);
    lilytank_.here.write("lab/a.csv", kTable);
    lilytank_.here.write("lab/b.csv", kTable);
    lilytank_.here.write("tracks/track00000000.csv", "% Frame number  x  y\n0\t0\t0\n1\t0.1\t0\n");
    lilytank_.here.write("t.txt", "###\n");
    lilytank_.here.write("tree.txt", "#-#-#\n");
    fs::create_symlink("a.csv", lilytank_.here.path("link.csv"));
  }

  /// Whether a dry run refuses just what the run itself does, in the same words.
  void refused_dry_as_well(const std::string& arguments) const {
    const auto before = lilytank_.files();
    const Answer dry = lilytank_(arguments + " --dry-run");
    EXPECT_EQ(lilytank_.files(), before) << arguments;
    const Answer real = lilytank_(arguments);
    EXPECT_EQ(real.code, 2) << arguments;
    EXPECT_EQ(dry.code, 2) << arguments;
    EXPECT_EQ(dry.err, real.err) << arguments;
    EXPECT_EQ(dry.out, "") << arguments;
  }
};

TEST_F(OutputsTest, WhatIsReadIsNotOverwritten) {
  const auto overwrites = [](const std::string& verb, const std::string& option,
                             const std::string& file) {
    return "lilytank " + verb + ": --" + option + " would overwrite '" + file +
           "', which is read; choose another name";
  };
  const std::string convert = "recording convert";
  refused(convert + " a.csv --out a.csv", overwrites(convert, "out", "a.csv"));
  refused(convert + " a.csv --out ./lab/../a.csv", overwrites(convert, "out", "a.csv"));
  refused(convert + " a.csv --out new/../a.csv", overwrites(convert, "out", "a.csv"));
  refused(convert + " a.csv --out link.csv", overwrites(convert, "out", "a.csv"));
  refused(convert + " lab/a.csv lab/b.csv --out lab", overwrites(convert, "out", "lab/a.csv"));
  refused(convert + " tracks --to swistrack-tracks --out tracks",
          overwrites(convert, "out", "tracks"));
  refused(convert + " tracks/track00000000.csv --to swistrack-tracks --out tracks",
          overwrites(convert, "out", "tracks/track00000000.csv"));
  refused("recording check lab/*.csv --csv lab/b.csv",
          overwrites("recording check", "csv", "lab/b.csv"));
  refused("synthesize t.txt --out t.txt", overwrites("synthesize", "out", "t.txt"));
  refused("synthesize t.txt --tree tree.txt --out ./tree.txt",
          overwrites("synthesize", "out", "tree.txt"));
  refused("check pair.rules --lattice 0 --kappa pair.rules",
          overwrites("check", "kappa", "pair.rules"));
  EXPECT_EQ(lilytank_(convert + " a.csv --out b.csv").code, 0);
  EXPECT_EQ(lilytank_(convert + " a.csv --to trex --out new").code, 0);
}

TEST_F(OutputsTest, AnAnalysisNeedsADirectoryOfItsOwn) {
  lilytank_.here.write("lab/summary.csv", kTable);
  ASSERT_EQ(lilytank_("run tiny.toml --out r --quiet").code, 0);
  const std::string message =
      "lilytank analyze: --out 'lab' holds 'lab/summary.csv', which is read; "
      "choose another directory";
  refused("analyze lab/summary.csv --out lab", message);
  EXPECT_EQ(lilytank_("analyze r --out r").code, 2);
  EXPECT_EQ(lilytank_("analyze r --out r/analysis").code, 0);
}

TEST_F(OutputsTest, TwoOutputsAreTwoFiles) {
  refused("synthesize t.txt --out a.svg --figure new/../a.svg",
          "lilytank synthesize: --out and --figure are one file, 'new/../a.svg'; choose two");
  refused("check pair.rules --lattice 0 --kappa k --bngl k",
          "lilytank check: --kappa and --bngl are one file, 'k'; choose two");
}

TEST_F(OutputsTest, ARunIsNotOverwrittenByItsFilm) {
  ASSERT_EQ(lilytank_("run tiny.toml --out r --quiet --set output.trajectory=csv").code, 0);
  for (const std::string own : {"trajectory.csv", "metrics.csv", "checkpoint.bin"}) {
    refused("recording convert r --out r/" + own,
            "lilytank recording convert: --out would overwrite 'r/" + own +
                "', which is read; choose another name");
  }
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(lilytank_("recording convert r --out r/film.csv").code, 0);
  }
}

TEST_F(OutputsTest, APipeStaysAPipe) {
  const std::string pipe = lilytank_.here.path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  const Answer a = lilytank_("synthesize t.txt --out pipe");
  EXPECT_EQ(a.code, 0) << a.err;
  std::string read(4096, '\0');
  const auto n = ::read(reader, read.data(), read.size());
  ::close(reader);
  ASSERT_GT(n, 0);
  read.resize(static_cast<std::size_t>(n));
  EXPECT_EQ(read, lilytank_("synthesize t.txt").out);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

// The shell opens the device; the program writes to what it was given.
TEST_F(OutputsTest, AFullDiskShowsInTheExitCode) {
  lilytank_.here.write("study.toml", "[study]\nscenario = \"pair.toml\"\nreplicates = 2\n");
  for (const std::string verb :
       {"help", "--version", "run --help", "forces", "info tiny.toml", "synthesize t.txt",
        "study slurm study.toml", "recording info a.csv", "run tiny.toml --quiet"}) {
    const Answer a = lilytank_(verb + " > /dev/full");
    EXPECT_EQ(a.code, 2) << verb;
    EXPECT_EQ(a.err, "cannot write to standard output\n") << verb;
  }
  EXPECT_EQ(lilytank_("recording convert a.csv --out b.csv > /dev/full").code, 0);  // is silent
}

TEST_F(OutputsTest, ADryRunRefusesWhatARunDoes) {
  lilytank_.here.write("file", "");
  lilytank_.here.write("taken/events.csv", "mine\n");
  ASSERT_EQ(lilytank_("run tiny.toml --out a --quiet").code, 0);
  for (const char* out : {"file", "file/below", "taken", "a"}) {
    refused_dry_as_well("run pair.toml --out " + std::string(out));
  }
  const Answer same = lilytank_("run tiny.toml --out a --dry-run");
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(lilytank_("run pair.toml --out a --force --dry-run").code, 0);
  EXPECT_EQ(lilytank_("run pair.toml --out new/below --dry-run").code, 0);
}

TEST_F(OutputsTest, ADryStudyRefusesWhatAStudyDoes) {
  lilytank_.here.write("study.toml", "[study]\nscenario = \"pair.toml\"\nreplicates = 2\n");
  lilytank_.here.write("other.toml",
                       "[study]\nscenario = \"pair.toml\"\nreplicates = 2\nseed = 5\n");
  lilytank_.here.write("file", "");
  lilytank_.here.write("mine/study.toml", "[study]\nscenario = \"../pair.toml\"\n");
  ASSERT_EQ(lilytank_("study study.toml --out a --quiet").code, 0);
  lilytank_.here.write("rows/rows-0001.csv", lilytank_.here.read("a/rows-0001.csv"));
  for (const char* out : {"file", "file/below", "mine", "a", "rows"}) {
    refused_dry_as_well("study other.toml --out " + std::string(out));
  }
  EXPECT_EQ(lilytank_("study study.toml --out a --dry-run").code, 0);
  EXPECT_EQ(lilytank_("study other.toml --out a --force --dry-run").code, 0);
}

TEST_F(OutputsTest, ADrySearchRefusesWhatASearchDoes) {
  lilytank_.here.write("search.toml", kSearch);
  lilytank_.here.write("other.toml", "[optimize]\nseed = 7\n" + kSearch.substr(11));
  lilytank_.here.write("race.toml", kSearch + "[race]\nrulesets = 2\nevaluations = 2\n");
  lilytank_.here.write("file", "");
  lilytank_.here.write("mine/history.csv", "mine\n");
  ASSERT_EQ(lilytank_("optimize search.toml --out a --quiet").code, 0);
  for (const char* out : {"file", "file/below", "mine", "a"}) {
    refused_dry_as_well("optimize other.toml --out " + std::string(out));
    refused_dry_as_well("optimize race.toml --out " + std::string(out));
  }
  const Answer same = lilytank_("optimize search.toml --out a --dry-run");
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(lilytank_("optimize other.toml --out a --force --dry-run").code, 0);
}

TEST_F(OutputsTest, ADryCheckRefusesWhatACheckDoes) {
  lilytank_.here.write("mine/rates.csv", "mine\n");
  lilytank_.here.write("file", "");
  const std::string check =
      "check " LILYTANK_SOURCE_DIR
      "/scenarios/rulesets/chain5.rules --lattice 1 --quiet "
      "--gillespie 2 --worlds 1 --duration 10 --modules 5 --measure " LILYTANK_SOURCE_DIR
      "/scenarios/chain5.toml --out ";
  for (const char* out : {"file", "mine"}) refused_dry_as_well(check + out);
  const Answer dry = lilytank_(check + "new --dry-run");
  EXPECT_EQ(dry.code, 0) << dry.err;
  for (const char* text :
       {"for 5 modules, with 1 simulation of the lattice model\n",
        "would measure rates in 1 simulation of 10 s of 5 modules\n", "would write to new\n"}) {
    EXPECT_NE(dry.out.find(text), std::string::npos) << text << "\n" << dry.out;
  }
  EXPECT_FALSE(lilytank_.here.has("new"));
}

#ifdef LILYTANK_HAS_RENDER
TEST_F(OutputsTest, ADryRenderRefusesWhatARenderDoes) {
  ASSERT_EQ(lilytank_("run tiny.toml --out run --set output.rate=10 --quiet").code, 0);
  lilytank_.here.write("f.png", "mine\n");
  lilytank_.here.write("film.gif", "mine\n");
  const std::string render = "render run --size 120 --fps 2 --quiet ";
  for (const char* what : {"--png f.png --at 1", "--gif film.gif"}) {
    refused_dry_as_well(render + what);
  }
  const Answer dry = lilytank_(render + "--stills new --speed 1 --to '2 s' --dry-run");
  EXPECT_EQ(dry.code, 0) << dry.err;
  EXPECT_EQ(dry.out,
            "would draw stills in new\nthe film has 4 frames, from 0 s to 1.5 s of the run\n");
  EXPECT_FALSE(lilytank_.here.has("new"));
}
#endif

}  // namespace
}  // namespace lilytank
