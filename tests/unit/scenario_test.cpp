#include "lilytank/scenario.hpp"

#include <fstream>

#include "io/scenario_keys.hpp"
#include "io/scenario_values.hpp"
#include "support/scenario_files.hpp"

namespace lilytank {
namespace {

using test::kRules;
using test::ScenarioTest;

TEST_F(ScenarioTest, EmptyFileIsTheStandardModel) {
  const Scenario s = load("");
  const Model standard = standard_model();
  EXPECT_EQ(s.model.module.count, standard.module.count);
  EXPECT_EQ(s.model.module.side, standard.module.side);
  EXPECT_EQ(s.model.tank.radius, standard.tank.radius);
  EXPECT_EQ(s.model.flow.K_v, standard.flow.K_v);
  EXPECT_EQ(s.model.dt, standard.dt);
  EXPECT_EQ(s.model.control.off_scale, standard.control.off_scale);
  ASSERT_EQ(s.model.forces.size(), standard.forces.size());
  for (std::size_t i = 0; i < s.model.forces.size(); ++i) {
    EXPECT_EQ(s.model.forces[i].term, standard.forces[i].term);
    EXPECT_EQ(s.model.forces[i].p, standard.forces[i].p);
  }
  const FlowSample here = s.model.field->at(0.1, 0.05), there = standard.field->at(0.1, 0.05);
  EXPECT_EQ(here.mu_x, there.mu_x);
  EXPECT_EQ(here.sigma_y, there.sigma_y);
  EXPECT_TRUE(s.model.rulesets.empty());
  EXPECT_EQ(s.seed, 1u);
}

TEST_F(ScenarioTest, NumbersMayHaveUnits) {
  const Scenario s = load(
      "[run]\nduration = \"4 h\"\ndt = \"5 ms\"\n[tank]\nradius = \"40 cm\"\n"
      "[module]\nmass = \"35 g\"\n[control]\ncapture_angle = \"10 deg\"\n"
      "[forces.stochastic]\nsigma_stoch = \"12.68 mN\"\n[output]\nrate = \"2 Hz\"\n");
  EXPECT_EQ(s.duration, 14400);
  EXPECT_EQ(s.model.steps_per_tick, 5);
  EXPECT_EQ(s.model.dt, kTick / 5);
  EXPECT_EQ(s.model.tank.radius, 0.4);
  EXPECT_EQ(s.model.module.mass, 0.035);
  EXPECT_DOUBLE_EQ(s.model.control.capture_angle, 0.17453292519943295);
  EXPECT_EQ(parameter(s, "stochastic", 0), 0.01268);
  EXPECT_EQ(s.output.rate, 2);
}

TEST_F(ScenarioTest, LaterFilesWinKeyByKeyAndSetsWinOverAll) {
  const std::string low = dir_.write("low.toml", "[tank]\nradius = 0.4\n[module]\ncount = 3\n");
  const std::string high = dir_.write("high.toml", "[module]\ncount = 4\nside = 0.03\n");
  const Scenario s = load_scenario({low, high}, {"module.side=0.02", "module.side = \"2.5 cm\""});
  EXPECT_EQ(s.model.tank.radius, 0.4);
  EXPECT_EQ(s.model.module.count, 4);
  EXPECT_EQ(s.model.module.side, 0.025);  // the last --set
  EXPECT_EQ(entry(s, "module.count").where.text(), high + ":2:9");
  EXPECT_EQ(entry(s, "tank.radius").where.file, low);
  EXPECT_TRUE(entry(s, "module.mass").is_default);
  EXPECT_FALSE(entry(s, "module.side").is_default);
}

TEST_F(ScenarioTest, BasesLieUnderAFileAndAreRelativeToIt) {
  dir_.write("a/deep.toml", "[tank]\nradius = 0.4\n[module]\ncount = 1\n");
  dir_.write("a/base.toml", "base = \"deep.toml\"\n[module]\ncount = 2\nside = 0.02\n");
  dir_.write("b.toml", "[module]\nside = 0.03\n");
  const Scenario s = load("base = [\"a/base.toml\", \"b.toml\"]\n[module]\nmass = 0.05\n");
  EXPECT_EQ(s.model.tank.radius, 0.4);
  EXPECT_EQ(s.model.module.count, 2);
  EXPECT_EQ(s.model.module.side, 0.03);
  EXPECT_EQ(s.model.module.mass, 0.05);
}

TEST_F(ScenarioTest, CirclesOfBasesAreRefused) {
  dir_.write("b.toml", "base = \"s.toml\"\n");
  EXPECT_EQ(refusal("base = \"b.toml\"\n"), "b.toml:1:8: base 's.toml' leads back to itself");
  EXPECT_EQ(refusal("base = \"none.toml\"\n"),
            "s.toml:1:8: cannot read 'none.toml': No such file or directory");
  EXPECT_EQ(refusal("base = 3\n"), "s.toml:1:8: base is a file name or a list of file names");
}

TEST_F(ScenarioTest, NamingAParameterSwitchesACandidateForceOn) {
  EXPECT_FALSE(is_on(load(""), "body_force"));
  EXPECT_TRUE(is_on(load("[forces.body_force]\nforce_x = 0.001\n"), "body_force"));
  EXPECT_TRUE(is_on(load("", {"forces.body_force.force_x=0"}), "body_force"));
  EXPECT_FALSE(is_on(load("[forces.body_force]\non = false\nforce_x = 0.001\n"), "body_force"));
  EXPECT_FALSE(is_on(load("[forces.damping]\non = false\nD_linear = 0.1\n"), "damping"));
  EXPECT_TRUE(is_on(load("[forces.damping]\nD_linear = 0.1\n"), "damping"));
}

TEST_F(ScenarioTest, NamingAFileChoosesIt) {
  dir_.write("f/flow.csv",
             "ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,measured\n"
             "0,0,-0.15,-0.15,0.1,0,0,0,1\n1,0,0.15,-0.15,0.1,0,0,0,1\n"
             "0,1,-0.15,0.15,0.1,0,0,0,1\n1,1,0.15,0.15,0.1,0,0,0,1\n");
  dir_.write("f/over.toml", "[flow]\nfile = \"flow.csv\"\n");
  EXPECT_EQ(load_scenario({dir_.path("f/over.toml")}, {}).model.field->at(0, 0).mu_x, 0.1);
  EXPECT_EQ(load("base = \"f/over.toml\"\n").model.field->at(0, 0).mu_x, 0.1);
  EXPECT_EQ(load("base = \"f/over.toml\"\n", {"flow.source=still"}).model.field->at(0, 0).mu_x, 0);
  dir_.write("poses.csv", "id,x,y,theta\n0,0.1,0,0\n1,-0.1,0.02,1.5707963267948966\n");
  const Scenario s = load("[start]\nfile = \"poses.csv\"\n[module]\ncount = 2\n");
  ASSERT_EQ(s.model.start.poses.size(), 2u);
  EXPECT_EQ(s.model.start.poses[1].x, -0.1);
  EXPECT_NEAR(s.model.start.poses[1].r.s, 1, 1e-15);
}

// As spreadsheets leave them: byte order mark, other separators and order of columns, blank lines.
TEST_F(ScenarioTest, FlowsAndPosesAreTextTables) {
  dir_.write("flow.csv",
             "\xef\xbb\xbfmeasured;ix;iy;x_m;y_m;mean_vx_mps;mean_vy_mps;std_vx_mps;std_vy_mps\r\n"
             "1;0;0;-0,15;-0,15;0,1;0;0;0\r\n\r\n1;1;0;0,15;-0,15;0,1;0;0;0\r\n"
             "1;1;1;0,15;0,15;0,1;0;0;0\r\n1;0;1;-0,15;0,15;0,1;0;0;0\r\n;;;;;;;;\r\n");
  dir_.write("poses.csv", "theta\tid\t\"x\"\ty\r0\t0\t0.1\t0\r0.5\t1\t-0.1\t0.02\r\r");
  const Scenario s =
      load("[flow]\nfile = \"flow.csv\"\n[start]\nfile = \"poses.csv\"\n[module]\ncount = 2\n");
  EXPECT_EQ(s.model.field->at(0, 0).mu_x, 0.1);
  ASSERT_EQ(s.model.start.poses.size(), 2u);
  EXPECT_EQ(s.model.start.poses[1].y, 0.02);
}

TEST_F(ScenarioTest, RulesHaveProbabilitiesThatCanBeSet) {
  dir_.write("r/pair.rules", kRules);
  const std::string text = "[ruleset]\nfile = \"r/pair.rules\"\n[rules]\npart.p = 0.25\n";
  EXPECT_EQ(load(text).model.rulesets.at(0).rules.at(1).p, 0.25);
  EXPECT_EQ(load(text, {"rules.part.p=1e-3"}).model.rulesets.at(0).rules.at(1).p, 1e-3);
  EXPECT_EQ(load(text, {"rules.part.p=\"5 %\""}).model.rulesets.at(0).rules.at(1).p, 0.05);
  EXPECT_EQ(refusal(text, {"rules.prat.p=1"}),
            "--set rules.prat.p=1: unknown key 'rules.prat.p' - did you mean 'part'?");
  EXPECT_EQ(refusal("[rules]\npart.p = 1\n"),
            "s.toml:1:2: 'rules.part.p' names a rule, but no ruleset.file is set");
}

TEST_F(ScenarioTest, CommandsAreReadInOrderOfTime) {
  dir_.write("one.rules", kRules), dir_.write("two.rules", kRules);
  const Scenario s = load(
      "[ruleset]\nfile = \"one.rules\"\n"
      "[[command]]\nat = \"1 h\"\ndo = \"ruleset\"\nfile = \"two.rules\"\n"
      "[[command]]\nat = 5\ndo = \"pause\"\nmodules = [2, 0]\n"
      "[[command]]\nat = 7200\ndo = \"ruleset\"\nfile = \"two.rules\"\n");
  ASSERT_EQ(s.model.commands.size(), 3u);
  EXPECT_EQ(s.model.commands[0].kind, CommandKind::pause);
  EXPECT_EQ(s.model.commands[0].modules, (std::vector<int>{2, 0}));
  EXPECT_EQ(s.model.commands[1].at, 3600);
  EXPECT_EQ(s.model.commands[1].ruleset, 1);
  EXPECT_EQ(s.model.commands[2].ruleset, 1);  // one file, one ruleset
  EXPECT_EQ(s.model.rulesets.size(), 2u);
}

TEST_F(ScenarioTest, CommandsMayGoWithFinishedCopiesAndSetThePumps) {
  dir_.write("one.rules", kRules), dir_.write("two.rules", kRules);
  const std::string text =
      "[ruleset]\nfile = \"one.rules\"\n[flow]\npump_power = 60\n"
      "[[command]]\ncopies = 2\ndo = \"ruleset\"\nfile = \"two.rules\"\n"
      "[[command]]\ncopies = 1\ndo = \"pump_power\"\npower = \"30 %\"\n"
      "[[command]]\nat = 9\ndo = \"pump_power\"\npower = 30\n"
      "[[command]]\nat = 12\ndo = \"pump_power\"\npower = 60\n";
  const Scenario s = load(text);
  ASSERT_EQ(s.model.commands.size(), 2u);
  EXPECT_EQ(s.model.commands[0].field, 1);
  EXPECT_EQ(s.model.commands[1].field, 0);  // as at the start
  ASSERT_EQ(s.model.feedback.size(), 2u);
  EXPECT_EQ(s.model.feedback[0].copies, 1);
  EXPECT_EQ(s.model.feedback[0].field, 1);
  EXPECT_EQ(s.model.feedback[1].ruleset, 1);
  ASSERT_EQ(s.model.other_fields.size(), 1u);
  const FlowSample full = s.model.field->at(0.1, 0.05);
  const FlowSample half = s.model.other_fields[0]->at(0.1, 0.05);
  EXPECT_NEAR(half.sigma_x, full.sigma_x / 2, 1e-12);
  TemporaryDirectory other;
  for (const auto& file : s.files) other.write(file.name, file.content);
  const Scenario again = load_scenario({other.write("resolved.toml", s.resolved)}, {});
  EXPECT_EQ(again.identity, s.identity);
}

TEST_F(ScenarioTest, CommandsOfALaterFileReplaceThoseBelow) {
  dir_.write("b.toml", "[[command]]\nat = 1\ndo = \"pause\"\n");
  EXPECT_EQ(load("base = \"b.toml\"\n").model.commands.size(), 1u);
  EXPECT_EQ(load("base = \"b.toml\"\ncommand = []\n").model.commands.size(), 0u);
}

TEST_F(ScenarioTest, ResolvedTextGivesTheSameScenarioAgain) {
  dir_.write("one.rules", kRules), dir_.write("two.rules", kRules + "# other\n");
  dir_.write("start.csv", "id,x,y,theta\n0,0.05,0,0\n1,-0.05,0.02,1.5\n2,0,0.06,-0.3\n");
  const Scenario first = load(
      "title = \"a \\\"quoted\\\" \\\\ title\\n\"\n[module]\ncount = 3\n[tank]\nradius = 0.1\n"
      "[start]\nradius = 0.1\nfile = \"start.csv\"\n[forces.body_force]\nforce_x = 1e-3\n"
      "[ruleset]\nfile = \"one.rules\"\n[rules.part]\np = 0.1\n"
      "[[command]]\nat = 5\ndo = \"query\"\nmodules = [1]\n"
      "[[command]]\nat = 3\ndo = \"ruleset\"\nfile = \"two.rules\"\n",
      {"run.dt=\"1 ms\"", "run.seed=77"});
  TemporaryDirectory other;
  for (const auto& file : first.files) other.write(file.name, file.content);
  const Scenario second = load_scenario({other.write("resolved.toml", first.resolved)}, {});
  EXPECT_EQ(second.resolved, first.resolved);
  EXPECT_EQ(second.identity, first.identity);
  EXPECT_EQ(second.title, first.title);
  EXPECT_EQ(second.seed, 77u);
  EXPECT_EQ(second.model.dt, first.model.dt);
  EXPECT_EQ(second.model.commands.size(), 2u);
  EXPECT_EQ(second.model.rulesets.at(0).rules.at(1).p, 0.1);
  EXPECT_TRUE(is_on(second, "body_force"));
  const std::vector<std::string> left_out = {"run.until", "run.until_copies", "run.quiet_time",
                                             "run.until_metric"};
  for (const ScenarioEntry& e : second.entries) {
    const bool off = std::count(left_out.begin(), left_out.end(), e.path) == 1;
    EXPECT_EQ(e.is_default, off) << e.path;
  }
}

TEST_F(ScenarioTest, IdentityTellsScenariosApart) {
  dir_.write("one.rules", kRules);
  const std::string text = "[ruleset]\nfile = \"one.rules\"\n";
  const auto identity = load(text).identity;
  EXPECT_EQ(load("# a comment changes nothing\n" + text).identity, identity);
  EXPECT_EQ(load(text + "[tank]\nradius = \"30 cm\"\n").identity, identity);  // the default
  EXPECT_EQ(load(text, {"run.until=end", "run.quiet_time=0"}).identity, identity);
  EXPECT_NE(load(text, {"run.quiet_time=60"}).identity, identity);
  EXPECT_NE(load(text, {"run.seed=2"}).identity, identity);
  EXPECT_NE(load(text, {"rules.part.p=0.4"}).identity, identity);
  dir_.write("one.rules", kRules + "# another file\n");
  EXPECT_NE(load(text).identity, identity);
}

TEST_F(ScenarioTest, EveryKeyExplainsItselfAndHasItsDefaultInBounds) {
  ScenarioDraft draft;
  std::vector<std::string> seen;
  for (const ScenarioKey& key : scenario_keys(draft)) {
    EXPECT_FALSE(key.meaning.empty()) << key.path;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), key.path), 0) << key.path;
    seen.push_back(key.path);
    if (const auto* const* v = std::get_if<double*>(&key.target)) {
      EXPECT_FALSE(key.unit.empty()) << key.path;
      EXPECT_GE(**v, key.low) << key.path;
      EXPECT_LE(**v, key.high) << key.path;
    }
  }
}

TEST_F(ScenarioTest, TheManualListsEveryKeyWithItsDefault) {
  std::ifstream in(LILYTANK_SOURCE_DIR "/scenarios/README.md");
  const std::string manual{std::istreambuf_iterator<char>(in), {}};
  ScenarioDraft draft;
  for (const ScenarioKey& key : scenario_keys(draft)) {
    if (key.path.starts_with("forces.")) continue;  // lilytank forces
    const std::string row = "| `" + key.path + "` | " + value_text(key);
    EXPECT_NE(manual.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace lilytank
