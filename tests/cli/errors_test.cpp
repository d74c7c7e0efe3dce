// What a user may get wrong: one line on stderr, exit code 2, nothing written.
#include <gtest/gtest.h>

#include "cli/program.hpp"

namespace lilytank {
namespace {

struct Mistake {
  std::string arguments, message;
};

class ErrorsTest : public testing::Test {
 protected:
  ErrorsTest() {
    lilytank_.here.write("tiny.toml", kTiny);
    lilytank_.here.write("quote.toml", "title = \"tank\n");
    lilytank_.here.write("key.toml", "\n\n[forces.face_drag]\nK_f = 1\n");
    lilytank_.here.write("range.toml", "[tank]\n\nradius = 300\n");
    lilytank_.here.write("full.toml", "[module]\ncount = 500\n");
    lilytank_.here.write("flow.toml", "[flow]\nfile = \"flow.csv\"\n");
    lilytank_.here.write("flow.csv", "x,y\n");
    lilytank_.here.write("bad.rules", "lilytank ruleset 1\nnome x\n");
    lilytank_.here.write("rules.toml", "[ruleset]\nfile = \"bad.rules\"\n");
    lilytank_.here.write("taken/events.csv", "mine\n");
    lilytank_.here.write("file", "");
    lilytank_.here.write("old/resolved.toml", "title = \"old\"\n");
  }

  void expect(const std::vector<Mistake>& mistakes) {
    const auto before = lilytank_.files();
    for (const Mistake& mistake : mistakes) {
      const Answer outcome = lilytank_(mistake.arguments);
      EXPECT_EQ(outcome.code, 2) << mistake.arguments;
      EXPECT_EQ(outcome.out, "") << mistake.arguments;
      EXPECT_EQ(outcome.err, mistake.message + "\n") << mistake.arguments;
      EXPECT_EQ(lilytank_.files(), before) << mistake.arguments;
      EXPECT_FALSE(lilytank_.here.has("out")) << mistake.arguments;
    }
  }
  Program lilytank_;
};

TEST_F(ErrorsTest, VerbsAndOptions) {
  expect({
      {"", "which verb? 'lilytank help' lists what there is"},
      {"rnu", "unknown verb 'rnu' - did you mean 'run'?"},
      {"xyzzy", "unknown verb 'xyzzy' - 'lilytank help' lists what there is"},
      {"help rendr", "unknown verb 'rendr' - did you mean 'render'?"},
      {"--versoin", "unknown verb '--versoin' - did you mean '--version'?"},
      {"run",
       "lilytank run: which scenario? write lilytank run SCENARIO, as scenarios/chain5.toml"},
      {"run tiny.toml --sede 3", "lilytank run: unknown option '--sede' - did you mean '--seed'?"},
      {"run tiny.toml -x", "lilytank run: unknown option '-x'"},
      {"run tiny.toml --seed x", "lilytank run: --seed x is not a whole number"},
      {"run tiny.toml --seed=-3", "lilytank run: --seed -3 is outside 0 .. 1000000000000000000"},
      {"run tiny.toml --out ''", "lilytank run: --out is empty"},
      {"info",
       "lilytank info: which scenario? write lilytank info SCENARIO, as "
       "scenarios/chain5.toml"},
      {"forces face_drga",
       "lilytank forces: unknown force 'face_drga' - did you mean 'face_drag'?"},
      {"forces a b", "lilytank forces: one name at a time, or none for all"},
  });
  const Answer missing = lilytank_("run tiny.toml --seed");
  EXPECT_EQ(missing.code, 2);
  EXPECT_TRUE(missing.err.starts_with("lilytank run: ")) << missing.err;
}

TEST_F(ErrorsTest, Scenarios) {
  expect({
      {"run none.toml", "cannot read 'none.toml': No such file or directory"},
      {"run key.toml", "key.toml:4:1: unknown key 'forces.face_drag.K_f' - did you mean 'K_F'?"},
      {"run quote.toml", "quote.toml:1:14: the quotation mark of this text is not closed"},
      {"info key.toml", "key.toml:4:1: unknown key 'forces.face_drag.K_f' - did you mean 'K_F'?"},
      {"run range.toml",
       "range.toml:3:10: tank.radius = 300 m is outside 0.05 .. 5 m - if this is in mm, write "
       "\"300 mm\""},
      {"run tiny.toml --set forces.stochastic.sigma_stoch='126.82 N'",
       "--set forces.stochastic.sigma_stoch=126.82 N: forces.stochastic.sigma_stoch = 126.82 N is "
       "outside 0 .. 1 N - the paper's table is in 1e-4 N: write 0.012682, in N"},
      {"run tiny.toml --set module.count",
       "--set module.count: write --set path=value, as in --set "
       "tank.radius=0.3"},
      {"run tiny.toml --set run.dt='7 ms'",
       "--set run.dt=7 ms: run.dt = 0.007 s is not 25 ms divided by a whole number - the nearest "
       "is "
       "0.00625 s, 25 ms / 4"},
      {"run flow.toml",
       "flow.csv:1:1: there is no column 'ix'; a flow grid has the columns "
       "ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,measured"},
  });
  const Answer rules = lilytank_("run rules.toml");
  EXPECT_EQ(rules.code, 2);
  EXPECT_TRUE(rules.err.starts_with("bad.rules:2:1: ")) << rules.err;
  const Answer full = lilytank_("run full.toml");
  EXPECT_EQ(full.code, 2);
  EXPECT_NE(full.err.find("of 500 bodies found room"), std::string::npos) << full.err;
  EXPECT_FALSE(lilytank_.here.has("out"));
}

TEST_F(ErrorsTest, Directories) {
  expect({
      {"run tiny.toml --out file", "'file' is a file; the results need a directory"},
      {"run tiny.toml --out taken",
       "'taken' holds a file 'events.csv' that is not of a run; choose another --out, or --force "
       "to "
       "replace it"},
      {"render none", "cannot read 'none': No such file or directory"},
  });
  const Answer old = lilytank_("run tiny.toml --out old");
  EXPECT_EQ(old.code, 2);
  EXPECT_TRUE(old.err.starts_with("'old' holds another run (there 'title = \"old\"', here '"))
      << old.err;
}

TEST_F(ErrorsTest, DamagedRuns) {
  ASSERT_EQ(lilytank_("run tiny.toml --out a").code, 0);
  const std::string good = lilytank_.here.read("a/checkpoint.bin");
  std::string bad = good;
  bad[good.size() / 2] ^= 1;
  for (const std::string& bytes : {bad, good.substr(0, good.size() - 1), std::string()}) {
    lilytank_.here.write("a/checkpoint.bin", bytes);
    const Answer outcome = lilytank_("run tiny.toml --out a");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err,
              "a/checkpoint.bin: the checkpoint is damaged; remove it to begin the run again\n");
  }
}

TEST_F(ErrorsTest, Pictures) {
#ifdef LILYTANK_HAS_RENDER
  ASSERT_EQ(lilytank_("run tiny.toml --out a").code, 0);
  ASSERT_EQ(lilytank_("run tiny.toml --out blind --set output.trajectory=none").code, 0);
  expect({
      {"render", "lilytank render: which run? write lilytank render RUN, as out/chain5-seed1"},
      {"render a --png x.jpg", "lilytank render: --png x.jpg does not end with .png"},
      {"render a --at 3", "lilytank render: --at goes with --png, --svg or --pdf"},
      {"render a --flow arows",
       "lilytank render: --flow arows is none of none, arrows, streamlines - did you mean "
       "'arrows'?"},
      {"render a --fps 0", "lilytank render: --fps 0 is outside 1 .. 240"},
      {"render a --fps many", "lilytank render: --fps many is not a number"},
      {"render a --from '3 m'", "lilytank render: --from is a time in s; 'm' is not"},
      {"render a --from 3 --to 2", "lilytank render: --to is not after --from"},
      {"render blind", "the run in 'blind' stored no poses: output.trajectory was \"none\""},
      {"run tiny.toml --video --set output.trajectory=none",
       "lilytank run: --video needs stored poses, but output.trajectory is \"none\""},
  });
#else
  expect({
      {"render a",
       "lilytank render: this program was built without the renderer (Cairo was not "
       "found)"},
      {"run tiny.toml --video",
       "lilytank run: --video: this program was built without the renderer "
       "(Cairo was not found)"},
  });
#endif
}

}  // namespace
}  // namespace lilytank
