// lilytank export: refusals, overwriting, and the provenance of results of several commands.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace lilytank {
namespace {

using Json = nlohmann::json;

class ExportVerb : public testing::Test {
 protected:
  ExportVerb() {
    lilytank_.here.write("tiny.toml", kTiny);
    EXPECT_EQ(lilytank_("run tiny.toml --out run --quiet").code, 0);
  }
  Json crate(const std::string& dir) {
    const Answer answer = lilytank_("export " + dir + " --format ro-crate");
    EXPECT_EQ(answer.code, 0) << answer.err;
    return Json::parse(lilytank_.here.read(dir + "/ro-crate-metadata.json"));
  }
  static Json entity(const Json& crate, const std::string& id) {
    for (const Json& one : crate["@graph"]) {
      if (one["@id"] == id) return one;
    }
    ADD_FAILURE() << "no entity " << id;
    return {};
  }
  Program lilytank_;
};

TEST_F(ExportVerb, ACrateNamesCommandProgramAndInputs) {
  const Json run = crate("run");
  EXPECT_EQ(entity(run, "#run")["name"], "lilytank run resolved.toml");
  EXPECT_EQ(entity(run, "./")["hasPart"].size(), entity(run, "#run")["result"].size());
  ASSERT_EQ(lilytank_("analyze run --out analysis").code, 0);
  const Json analysis = crate("analysis");
  EXPECT_TRUE(std::string(entity(analysis, "#run")["name"]).starts_with("lilytank analyze run"));
  EXPECT_FALSE(entity(analysis, "#run")["object"].empty());
}

TEST_F(ExportVerb, RepeatsAndReplacesOnlyWithForce) {
  EXPECT_EQ(lilytank_("export run --format ro-crate").code, 0);
  EXPECT_EQ(lilytank_("export run --format ro-crate").code, 0) << "the same contents";
  lilytank_.here.write("run/ro-crate-metadata.json", "mine");
  const Answer refused = lilytank_("export run --format ro-crate");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("--force"), std::string::npos) << refused.err;
  EXPECT_EQ(lilytank_("export run --format ro-crate --force").code, 0);
}

TEST_F(ExportVerb, RefusesWhatIsNoResult) {
  for (const char* words : {"export nothing", "export nothing --format ro-crate", "export .",
                            "export run --format parquet", "export run --license x",
                            "export run --format ro-crate --out x", "export", "export run run"}) {
    const Answer answer = lilytank_(words);
    EXPECT_EQ(answer.code, 2) << words;
    EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
  }
}

}  // namespace
}  // namespace lilytank
