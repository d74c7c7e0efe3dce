// Every verb end to end on tiny inputs.
#include <gtest/gtest.h>

#include "cli/program.hpp"

namespace lilytank {
namespace {

using Names = std::vector<std::string>;

class VerbsTest : public testing::Test {
 protected:
  VerbsTest() {
    lilytank_.here.write("tiny.toml", kTiny);
    lilytank_.here.write("pair.rules", kPairRules);
    lilytank_.here.write("pair.toml",
                         "base = \"tiny.toml\"\n[run]\nduration = 60\n[module]\ncount = 8\n"
                         "[ruleset]\nfile = \"pair.rules\"\n");
  }
  std::size_t lines(const std::string& file) const {
    const std::string content = lilytank_.here.read(file);
    return static_cast<std::size_t>(std::count(content.begin(), content.end(), '\n'));
  }
  Program lilytank_;
};

TEST_F(VerbsTest, VersionAndHelp) {
  const Answer version = lilytank_("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_TRUE(version.out.starts_with("lilytank ")) << version.out;
  for (const char* words : {"help", "--help", "-h"}) {
    const Answer help = lilytank_(words);
    EXPECT_EQ(help.code, 0);
    for (const char* verb : {"run", "info", "forces", "render", "synthesize", "check"}) {
      EXPECT_NE(help.out.find(verb), std::string::npos) << verb;
    }
  }
  for (const std::string verb : {"run", "info", "forces", "render", "synthesize", "check"}) {
    const Answer help = lilytank_("help " + verb);
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.out.find("lilytank " + verb), std::string::npos) << help.out;
    EXPECT_EQ(lilytank_(verb + " --help").out, help.out);
  }
}

TEST_F(VerbsTest, RunWritesItsFiles) {
  const Answer run = lilytank_("run pair.toml");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(lilytank_.names("out"),
            (Names{"tiny-seed1/bonds.csv", "tiny-seed1/checkpoint.bin", "tiny-seed1/events.csv",
                   "tiny-seed1/metrics.csv", "tiny-seed1/resolved.toml", "tiny-seed1/rules.csv",
                   "tiny-seed1/ruleset.rules", "tiny-seed1/species.csv", "tiny-seed1/summary.json",
                   "tiny-seed1/summary.txt", "tiny-seed1/trajectory.bin"}));
  EXPECT_EQ(run.out, lilytank_.here.read("out/tiny-seed1/summary.txt"));
  EXPECT_EQ(fingerprint_of(run.out).size(), 16u);
  EXPECT_EQ(run.out.find_first_not_of("0123456789abcdef\n", run.out.size() - 17),
            std::string::npos);
  EXPECT_EQ(run.err.find('\r'), std::string::npos);         // no terminal, no changing line
  EXPECT_EQ(lines("out/tiny-seed1/metrics.csv"), 1u + 7u);  // 0, 10, ... 60 s
  EXPECT_EQ(lines("out/tiny-seed1/rules.csv"), 3u);
  const std::string events = lilytank_.here.read("out/tiny-seed1/events.csv");
  for (const char* kind : {",latch,", ",link,", ",copy,", ",join,"}) {
    EXPECT_NE(events.find(kind), std::string::npos) << kind;
  }
}

TEST_F(VerbsTest, SameSeedSameBytesOtherSeedOtherFingerprint) {
  const Answer first = lilytank_("run pair.toml --out a --seed 5");
  const Answer second = lilytank_("run pair.toml --out b --seed 5 --quiet");
  const Answer other = lilytank_("run pair.toml --out c --set run.seed=6");
  EXPECT_EQ(first.out, second.out);
  EXPECT_EQ(lilytank_.files("a"), lilytank_.files("b"));
  EXPECT_EQ(second.err, "");
  EXPECT_NE(fingerprint_of(first.out), fingerprint_of(other.out));
}

TEST_F(VerbsTest, ResolvedScenarioRunsToTheSameEnd) {
  const Answer first = lilytank_("run pair.toml --out a --set output.trajectory=csv");
  const Answer again = lilytank_("run a/resolved.toml --out b");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(first.out, again.out);
  EXPECT_EQ(lilytank_.files("a"), lilytank_.files("b"));
  EXPECT_TRUE(lilytank_.here.has("a/trajectory.csv"));
}

TEST_F(VerbsTest, ACompleteRunIsToldAgain) {
  const Answer first = lilytank_("run pair.toml --out a");
  const auto files = lilytank_.files("a");
  const Answer again = lilytank_("run pair.toml --out a");
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(again.out, first.out);
  EXPECT_NE(again.err.find("complete already"), std::string::npos) << again.err;
  EXPECT_EQ(lilytank_.files("a"), files);
  std::filesystem::remove(lilytank_.here.path("a/summary.txt"));  // made anew from the checkpoint
  EXPECT_EQ(lilytank_("run pair.toml --out a").out, first.out);
  EXPECT_EQ(lilytank_.files("a"), files);
}

TEST_F(VerbsTest, AnotherRunIsReplacedOnlyByForce) {
  lilytank_("run pair.toml --out a");
  const auto files = lilytank_.files("a");
  const Answer refused = lilytank_("run tiny.toml --out a");
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.err,
            "'a' holds another run (there 'duration = 60', here 'duration = 5'); choose another "
            "--out, or --force to replace it\n");
  EXPECT_EQ(lilytank_.files("a"), files);
  EXPECT_EQ(lilytank_("run tiny.toml --out a --force").code, 0);
  lilytank_("run tiny.toml --out b");
  EXPECT_EQ(lilytank_.files("a"), lilytank_.files("b"));
}

TEST_F(VerbsTest, DryRunWritesNothing) {
  const auto before = lilytank_.files();
  const Answer dry = lilytank_("run pair.toml --dry-run");
  EXPECT_EQ(dry.code, 0) << dry.err;
  EXPECT_NE(dry.out.find("60 s of 8 modules"), std::string::npos) << dry.out;
  EXPECT_NE(dry.out.find("out/tiny-seed1"), std::string::npos) << dry.out;
  EXPECT_EQ(lilytank_.files(), before);
  EXPECT_FALSE(lilytank_.here.has("out"));
}

TEST_F(VerbsTest, ADivergedWorldIsAResult) {
  const std::string run =
      "run tiny.toml --out a --set module.mass='0.1 g' --set forces.body_force.force_x=1";
  const Answer first = lilytank_(run);
  EXPECT_EQ(first.code, 1);
  EXPECT_NE(first.err.find("diverged at 0 s (step 0): module "), std::string::npos) << first.err;
  EXPECT_NE(first.out.find("diverged"), std::string::npos) << first.out;
  EXPECT_TRUE(lilytank_.here.has("a/trajectory.bin"));
  const Answer again = lilytank_(run);
  EXPECT_EQ(again.code, 1);
  EXPECT_EQ(again.out, first.out);
}

TEST_F(VerbsTest, CommandsAppearAmongTheEvents) {
  lilytank_.here.write("c.toml",
                       "base = \"pair.toml\"\n[[command]]\nat = 1\ndo = \"query\"\nmodules = [3]\n"
                       "[[command]]\nat = 2\ndo = \"ruleset\"\nfile = \"pair.rules\"\n");
  const Answer run = lilytank_("run c.toml --out a");
  EXPECT_EQ(run.code, 0) << run.err;
  const std::string events = lilytank_.here.read("a/events.csv");
  EXPECT_NE(events.find(",command,,,,,query,"), std::string::npos) << events.substr(0, 2000);
  EXPECT_NE(events.find(",command,,,,,ruleset,"), std::string::npos) << events.substr(0, 2000);
  EXPECT_NE(events.find(",report,3,"), std::string::npos) << events.substr(0, 2000);
  EXPECT_TRUE(lilytank_.here.has("a/ruleset_2.rules"));
}

TEST_F(VerbsTest, InfoExplainsEveryValue) {
  const Answer info = lilytank_("info pair.toml --set tank.radius='40 cm'");
  EXPECT_EQ(info.code, 0) << info.err;
  for (const char* part : {"tank.radius", "0.4 m", "0.05 .. 5", "set at --set tank.radius=40 cm",
                           "set at pair.toml:3:12", "default", "rules.part.p", "possible copies  4",
                           "bodies           8", "steps            2400", "join:"}) {
    EXPECT_NE(info.out.find(part), std::string::npos) << part;
  }
}

TEST_F(VerbsTest, ForcesDocumentsEachTerm) {
  const Answer all = lilytank_("forces");
  EXPECT_EQ(all.code, 0);
  for (const char* part : {"face_drag (on by default)", "forces.face_drag.K_F = 0.442",
                           "forces.stochastic.sigma_stoch = 0.012682 N", "body_force\n"}) {
    EXPECT_NE(all.out.find(part), std::string::npos) << part;
  }
  const Answer one = lilytank_("forces damping");
  EXPECT_EQ(one.code, 0);
  EXPECT_NE(all.out.find(one.out), std::string::npos);
  EXPECT_EQ(one.out.find("face_drag"), std::string::npos);
}

TEST_F(VerbsTest, ShippedScenariosLoad) {
  const std::string folder = LILYTANK_SOURCE_DIR "/scenarios/";
  for (const std::string files :
       {"tank_lilies.toml", "tank_balls.toml", "chain5.toml", "cross5.toml",
        "chain5.toml p_empirical_chain.toml", "chain5.toml p_optimised_chain.toml",
        "cross5.toml p_empirical_cross.toml", "cross5.toml p_optimised_cross.toml"}) {
    std::string arguments = "run --dry-run";
    for (std::size_t at = 0; at < files.size();) {
      const auto end = std::min(files.find(' ', at), files.size());
      arguments += " '" + folder + files.substr(at, end - at) + "'";
      at = end + 1;
    }
    const Answer dry = lilytank_(arguments);
    EXPECT_EQ(dry.code, 0) << files << ": " << dry.err;
  }
}

TEST_F(VerbsTest, TheDemoBuildsAllItsChains) {
  const Answer demo = lilytank_("run '" LILYTANK_SOURCE_DIR "/scenarios/demo.toml' --out demo");
  EXPECT_EQ(demo.code, 0) << demo.err;
  EXPECT_NE(demo.out.find("3 of 3 possible"), std::string::npos) << demo.out;
}

#ifdef LILYTANK_HAS_RENDER
TEST_F(VerbsTest, RenderDrawsFramesAndFilms) {
  lilytank_("run pair.toml --out a --set run.duration=2");
  const Answer frames = lilytank_("render a --png f.png --svg f.svg --at 1 --size 180 --flow none");
  EXPECT_EQ(frames.code, 0) << frames.err;
  EXPECT_EQ(frames.out, "f.png\nf.svg\n");
  EXPECT_TRUE(lilytank_.here.read("f.png").starts_with("\x89PNG"));
  const Answer stills = lilytank_("render a --stills s --fps 2 --speed 1 --size 180 --to '1 s'");
  EXPECT_EQ(stills.code, 0) << stills.err;
  EXPECT_GE(lilytank_.names("s").size(), 2u);
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "there is no ffmpeg here";
  const Answer film = lilytank_("render a --fps 5 --speed 2 --size 180 --no-labels --trail 1");
  EXPECT_EQ(film.code, 0) << film.err;
  EXPECT_EQ(film.out, "a/video.mp4\n");
  EXPECT_GT(lilytank_.here.read("a/video.mp4").size(), 500u);
}

TEST_F(VerbsTest, RenderTellsOfPosesStoredTooSeldom) {
  const std::string run = "run pair.toml --set run.duration=6 --set output.rate=";
  lilytank_(run + "0.5 --out seldom");
  lilytank_(run + "20 --out often");
  const std::string stills = " --stills s --fps 5 --speed 1 --size 120 --flow none --quiet";
  const Answer film = lilytank_("render seldom" + stills);
  EXPECT_EQ(film.code, 0);
  EXPECT_TRUE(film.err.starts_with("poses were stored 0.5 times a second; between them one body"))
      << film.err;
  EXPECT_TRUE(film.err.ends_with("(run with --set output.rate=20)\n")) << film.err;
  EXPECT_EQ(lilytank_("render often --force" + stills).err, "");
  const std::string frame = "render seldom --png f.png --size 120 --quiet --at ";
  EXPECT_EQ(lilytank_(frame + "4").err, "") << "just where poses were stored";
  EXPECT_TRUE(
      lilytank_(frame + "3 --force").err.starts_with("poses were stored 0.5 times a second"));
}

TEST_F(VerbsTest, AFilmThatCannotBeMadeIsRefusedBeforeTheRun) {
  const std::string before = std::getenv("PATH");
  ::setenv("PATH", "/no/programs/here", 1);
  const Answer run = lilytank_("run pair.toml --out a --video");
  const Answer dry = lilytank_("run pair.toml --out a --video --dry-run");
  ::setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.err,
            "cannot make films: the program ffmpeg is not in PATH; install it, or draw stills\n");
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(dry.code, 2);
  EXPECT_FALSE(lilytank_.here.has("a"));
}
#endif

}  // namespace
}  // namespace lilytank
