// What editors, shells and other programs read: schemas, completion, manual pages, JSON.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace lilytank {
namespace {

using Json = nlohmann::json;

class ShellsTest : public testing::Test {
 protected:
  ShellsTest() { lilytank_.here.write("tiny.toml", kTiny); }
  Program lilytank_;
};

TEST_F(ShellsTest, ASchemaHoldsTheBoundsOfTheProgram) {
  const Json schema = Json::parse(lilytank_("schema scenario").out);
  const Json& drag = schema["properties"]["forces"]["properties"]["face_drag"]["properties"]["K_F"];
  EXPECT_EQ(drag["anyOf"][0]["maximum"], 10);
  EXPECT_NE(std::string(drag["description"]).find("default 0.442"), std::string::npos);
  EXPECT_EQ(schema["properties"]["module"]["properties"]["count"]["type"], "integer");
  EXPECT_EQ(schema["additionalProperties"], false);
  const Json study = Json::parse(lilytank_("schema study").out);
  EXPECT_EQ(study["properties"]["study"]["required"], Json::array({"scenario"}));
}

TEST_F(ShellsTest, SchemasAreOfFiveKindsOfFiles) {
  for (const char* kind : {"scenario", "experiment", "bodies", "study", "optimize"}) {
    EXPECT_EQ(lilytank_(std::string("schema ") + kind).code, 0) << kind;
  }
  const Answer other = lilytank_("schema studdy");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("did you mean 'study'?"), std::string::npos) << other.err;
}

TEST_F(ShellsTest, CompletionKnowsVerbsOptionsAndKeys) {
  const auto has = [&](const std::string& words, const std::string& candidate) {
    const std::string out = "\n" + lilytank_("completion candidates -- " + words).out;
    return out.find("\n" + candidate + "\n") != std::string::npos;
  };
  EXPECT_TRUE(has("di", "diagnose"));
  EXPECT_TRUE(has("diagnose --b", "--budget"));
  EXPECT_TRUE(has("recording convert --", "--out"));
  EXPECT_TRUE(has("run --set tank", "tank.radius="));
  EXPECT_EQ(lilytank_("completion candidates -- run scen").out, "") << "files are the shell's";
  for (const char* shell : {"bash", "zsh", "fish"}) {
    EXPECT_NE(lilytank_(std::string("completion ") + shell).out.find("lilytank completion"),
              std::string::npos);
  }
}

TEST_F(ShellsTest, ShellsReadTheirScripts) {
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const std::string there = "command -v " + shell + " > /dev/null 2>&1";
    if (std::system(there.c_str()) != 0) continue;
    lilytank_.here.write(shell, lilytank_("completion " + shell).out);
    EXPECT_EQ(std::system((shell + " -n '" + lilytank_.here.path(shell) + "'").c_str()), 0)
        << shell;
  }
}

TEST_F(ShellsTest, AManualPageShowsEveryOption) {
  const std::string page = lilytank_("man diagnose").out;
  EXPECT_TRUE(page.starts_with(".TH lilytank\\-diagnose 1 "));
  EXPECT_NE(page.find(".B \\-\\-budget \\fIMINUTES\\fR"), std::string::npos);
  EXPECT_NE(lilytank_("man").out.find("lilytank\\-study"), std::string::npos);
  EXPECT_EQ(lilytank_("man nothing").code, 2);
}

TEST_F(ShellsTest, InfoShowsAPart) {
  const std::string only = lilytank_("info tiny.toml --only tank.").out;
  EXPECT_TRUE(only.starts_with("tank.radius")) << only;
  EXPECT_EQ(std::count(only.begin(), only.end(), '\n'), 1);
  const std::string changed = lilytank_("info tiny.toml --changed --set tank.radius=0.31").out;
  EXPECT_NE(changed.find("tank.radius"), std::string::npos);
  EXPECT_EQ(changed.find("default -"), std::string::npos) << changed;
  EXPECT_EQ(lilytank_("info tiny.toml --only tonk").code, 2);
}

TEST_F(ShellsTest, InfoAsJson) {
  const Json info =
      Json::parse(lilytank_("info tiny.toml --json --only tank.radius --set tank.radius=0.31").out);
  ASSERT_EQ(info["values"].size(), 1u);
  EXPECT_EQ(info["values"][0]["value"], "0.31");
  EXPECT_EQ(info["values"][0]["default"], false);
}

TEST_F(ShellsTest, MistakesOfTheCommandLineAreNamed) {
  const auto says = [&](const std::string& words, const std::string& text) {
    const Answer answer = lilytank_(words);
    EXPECT_EQ(answer.code, 2) << words;
    EXPECT_NE(answer.err.find(text), std::string::npos) << answer.err;
  };
  says("simulate tiny.toml", "did you mean 'run'?");
  says("run tinny.toml", "No such file or directory - did you mean 'tiny.toml'?");
  says("run tiny.toml --set title=\\\"x", "is not closed");
  EXPECT_EQ(lilytank_("-V").out, lilytank_("--version").out);
}

}  // namespace
}  // namespace lilytank
