// lilytank view: what users see. The page itself: tests/pages/view.sh.
#include "cli/refusals.hpp"

namespace lilytank {
namespace {

const std::string kExperiment = "'" LILYTANK_SOURCE_DIR "/scenarios/experiments/tank.toml'";
const std::string kDiagnosis =
    R"({"name": "tank", "verdict": "missing", "findings": [{"effect": "pair_repulsion"}],)"
    R"( "parameters": [{"path": "flow.K_v", "alone": 1.1}]})";

class ViewVerb : public RefusalTest {
 protected:
  void make_run(const std::string& name) const {
    ASSERT_EQ(lilytank_("run pair.toml --set run.duration=2 --quiet --out " + name).code, 0);
  }
};

TEST_F(ViewVerb, ThePageOfARunHoldsEverythingAndIsTheSameAgain) {
  make_run("a");
  const Answer made = lilytank_("view a --quiet");
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.out, "a/view.html\n");
  const std::string page = lilytank_.here.read("a/view.html");
  EXPECT_TRUE(page.starts_with("<!doctype html>"));
  EXPECT_EQ(page.find("{{"), std::string::npos);
  for (const char* outside : {"src=", "href=", "url(", "import "}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  EXPECT_EQ(lilytank_("view a --quiet").code, 0);
  EXPECT_EQ(lilytank_.here.read("a/view.html"), page);
}

TEST_F(ViewVerb, ReplacesNoOtherPageWithoutForce) {
  make_run("a");
  lilytank_.here.write("a/view.html", "mine");
  EXPECT_EQ(lilytank_("view a --quiet").code, 2);
  EXPECT_EQ(lilytank_.here.read("a/view.html"), "mine");
  EXPECT_EQ(lilytank_("view a --quiet --force").code, 0);
}

TEST_F(ViewVerb, RefusesWhatItCannotShow) {
  make_run("a");
  refused("view", "lilytank view: of what? write lilytank view RUN, as out/chain5-seed1");
  refused("view .", "'.' is not the directory of a run, study or diagnosis");
  refused("view a a a a a", "lilytank view: a page shows at most 4 runs");
  refused("view a --run 1f", "lilytank view: --run goes with a study");
  refused("view a --recording x.csv", "lilytank view: --recording goes with a diagnosis");
}

TEST_F(ViewVerb, AStudyIsSimulatedAgain) {
  const std::string study = "[study]\nname = \"pairs\"\nscenario = \"pair.toml\"\nreplicates = 2\n";
  lilytank_.here.write("pairs.toml", study);
  lilytank_.here.write("other.toml", study + "seed = 7\n");
  ASSERT_EQ(lilytank_("study pairs.toml --set run.duration=2 --quiet --out s").code, 0);
  const Answer made = lilytank_("view s pairs.toml --quiet");  // with the study's --set
  EXPECT_EQ(made.code, 0) << made.err;
  const std::string page = lilytank_.here.read("s/view.html");
  EXPECT_NE(page.find("mean of 2 runs"), std::string::npos);
  refused("view s",
          "lilytank view: 's' holds a study; write lilytank view STUDY STUDY.toml, with the file "
          "that was run");
  ASSERT_EQ(lilytank_("study pairs.toml --set run.duration=2 --seed 7 --quiet --out t").code, 0);
  EXPECT_EQ(lilytank_("view t pairs.toml --quiet").code, 0) << "with the study's --seed";
  EXPECT_EQ(lilytank_("study status pairs.toml --set run.duration=2 --seed 7 --out t").code, 0);
  refused("view s other.toml --quiet", "'s' holds the results of another study than pairs");
  refused("view s pairs.toml --quiet --run 0123456789abcdef",
          "'0123456789abcdef' is no run of the study; table.csv lists them");
}

TEST_F(ViewVerb, ADiagnosisShowsARecordingBesideSimulations) {
  lilytank_.here.write("d/diagnosis.json", kDiagnosis);
  lilytank_.here.write("d/missing.toml", "forces.pair_repulsion.strength = 0.005\n");
  const Answer made = lilytank_("view d " + kExperiment + " --quiet");
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string page = lilytank_.here.read("d/view.html");
  for (const char* name : {"\"recorded\"", "\"lily_2\"", "\"baseline\"", "\"with pair_repulsion\"",
                           "Diagnosis of tank"}) {
    EXPECT_NE(page.find(name), std::string::npos) << name;
  }
  EXPECT_EQ(lilytank_("view d " + kExperiment + " --recording lily_1.csv.gz --quiet --force").code,
            0);
  refused("view d",
          "lilytank view: 'd' holds a diagnosis; write lilytank view DIAGNOSIS "
          "EXPERIMENT.toml, with the diagnosed file");
  EXPECT_EQ(lilytank_("view d " + kExperiment + " --recording lily_3 --out o.html").code, 2);
  lilytank_.here.write("d/diagnosis.json", "{\"name\": 3}");
  EXPECT_EQ(lilytank_("view d " + kExperiment + " --out o.html").code, 2);
}

}  // namespace
}  // namespace lilytank
