#include "lilytank/scenario.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "io/scenario_keys.hpp"
#include "io/scenario_values.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

using Texts = std::vector<std::string>;

class ScenarioTest : public testing::Test {
 protected:
  /// Loads one file of this content.
  Scenario load(const std::string& content, const Texts& sets = {}) const {
    return load_scenario({dir_.write("s.toml", content)}, sets);
  }
  std::string refusal(const std::string& content, const Texts& sets = {}) const {
    try {
      load(content, sets);
    } catch (const InputError& e) {
      // Without the temporary directory's name.
      std::string what = e.what();
      for (auto at = what.find(dir_.path()); at != std::string::npos; at = what.find(dir_.path())) {
        what.erase(at, dir_.path().size());
      }
      return what;
    }
    return "(accepted)";
  }
  static const ScenarioEntry& entry(const Scenario& scenario, const std::string& path) {
    const auto found = std::find_if(scenario.entries.begin(), scenario.entries.end(),
                                    [&](const ScenarioEntry& e) { return e.path == path; });
    EXPECT_NE(found, scenario.entries.end()) << path;
    return *found;
  }
  static double parameter(const Scenario& scenario, const std::string& term, std::size_t i) {
    for (const ActiveForce& force : scenario.model.forces) {
      if (force.term->name() == term) return force.p.at(i);
    }
    ADD_FAILURE() << term << " is not on";
    return 0;
  }
  static bool is_on(const Scenario& scenario, const std::string& term) {
    return std::any_of(scenario.model.forces.begin(), scenario.model.forces.end(),
                       [&](const ActiveForce& force) { return force.term->name() == term; });
  }
  TemporaryDirectory dir_;
};

const std::string kRules =
    "lilytank ruleset 1\nname pair\nhops counter-clockwise\ntarget\n  ##\nend\n"
    "join: (0,0) (0,0) -> (1,1)-(2,1)  p=1\npart: (1,1)-(2,1) -> (0,0) (0,0)  p=0.5\n";

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
  dir_.write("start.csv", "id,x,y,theta\n0,0.1,0,0\n1,-0.1,0.02,1.5\n2,0,0.1,-0.3\n");
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
  for (const ScenarioEntry& e : second.entries) EXPECT_FALSE(e.is_default) << e.path;
}

TEST_F(ScenarioTest, IdentityTellsScenariosApart) {
  dir_.write("one.rules", kRules);
  const std::string text = "[ruleset]\nfile = \"one.rules\"\n";
  const auto identity = load(text).identity;
  EXPECT_EQ(load("# a comment changes nothing\n" + text).identity, identity);
  EXPECT_EQ(load(text + "[tank]\nradius = \"30 cm\"\n").identity, identity);  // the default
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

struct Refusal {
  std::string content, message;
};

// Every message of the loader, once. Places count from 1.
TEST_F(ScenarioTest, RefusesWithPlaceAndAdvice) {
  const std::vector<Refusal> all{
      {"\n[forces.face_drag]\nK_f = 1\n",
       "s.toml:3:1: unknown key 'forces.face_drag.K_f' - did you mean 'K_F'?"},
      {"[forces.face_drga]\nK_F = 1\n",
       "s.toml:1:9: unknown key 'forces.face_drga.K_F' - did you mean 'face_drag'?"},
      {"[forces.face_drga]\n",
       "s.toml:1:9: unknown key 'forces.face_drga' - did you mean 'face_drag'?"},
      {"radius = 1\n", "s.toml:1:1: unknown key 'radius' - did you mean 'tank.radius'?"},
      {"[tank]\nviscosity = 1\n", "s.toml:2:1: unknown key 'tank.viscosity' - 'tank' has radius"},
      {"[tank]\nradius.x = 1\n", "s.toml:2:8: 'tank.radius' is a value and has no 'x'"},
      {"tank = 1\n", "s.toml:1:8: 'tank' is a table with radius"},
      {"[tank]\n\nradius = 300\n",
       "s.toml:3:10: tank.radius = 300 m is outside 0.05 .. 5 m - if this is in mm, write \"300 "
       "mm\""},
      {"[tank]\nradius = \"300 m\"\n", "s.toml:2:10: tank.radius = 300 m is outside 0.05 .. 5 m"},
      {"[tank]\nradius = \"3 km\"\n",
       "s.toml:2:10: tank.radius = 3 km (3000 m) is outside 0.05 .. 5 m"},
      {"[tank]\nradius = \"3 kg\"\n", "s.toml:2:10: tank.radius is a length in m; 'kg' is not"},
      {"[tank]\nradius = true\n", "s.toml:2:10: tank.radius is a length in m, not a switch"},
      {"[tank]\nradius = [1]\n", "s.toml:2:10: tank.radius is a length in m, not a list"},
      {"[tank]\nradius = nan\n", "s.toml:2:10: tank.radius = nan is not a finite number"},
      {"[tank]\nradius = -inf\n", "s.toml:2:10: tank.radius = -inf is not a finite number"},
      {"[run]\nseed = 1.5\n", "s.toml:2:8: run.seed is a whole number; 1.5 is not"},
      {"[run]\nseed = -1\n", "s.toml:2:8: run.seed = -1 is outside 0 .. 1e+18"},
      {"[control]\nreply_ticks = 254\n",
       "s.toml:2:15: control.reply_ticks = 254 is outside 1 .. 253"},
      {"[run]\nseed = \"1\"\n", "s.toml:2:8: run.seed is a whole number, not text"},
      {"[module]\nshadowing = 1\n",
       "s.toml:2:13: module.shadowing is a switch, true or false, not a whole number"},
      {"title = 1979-05-27\n", "s.toml:1:9: title is text in quotes, not a date or time"},
      {"[flow]\ngusts = \"per_modul\"\n",
       "s.toml:2:9: flow.gusts = \"per_modul\" is none of per_point, per_module, moment_matched - "
       "did you mean "
       "'per_module'?"},
      {"[forces.stochastic]\nsigma_stoch = 126.82\n",
       "s.toml:2:15: forces.stochastic.sigma_stoch = 126.82 N is outside 0 .. 1 N - the paper's "
       "table is in 1e-4 N: write 0.012682, in N"},
      {"[forces.face_drag]\nsegments = 2.5\n",
       "s.toml:2:12: forces.face_drag.segments is a whole number; 2.5 is not"},
      {"[run]\ndt = 0.007\n",
       "s.toml:2:6: run.dt = 0.007 s is not 25 ms divided by a whole number - the nearest is "
       "0.00625 s, 25 ms / 4"},
      {"[module]\ncount = 0\n",
       "s.toml:2:9: there is nothing to simulate: module.count and ball.count are both 0"},
      {"[start]\nradius = 0.4\n",
       "s.toml:2:10: start.radius = 0.4 m is beyond tank.radius = 0.3 m"},
      {"[start]\nlayout = \"lattice\"\ndistance = 0.02\n",
       "s.toml:3:12: start.distance = 0.02 m: bodies of 0.035 m would overlap on the lattice"},
      {"[start]\nlayout = \"poses\"\n", "s.toml:2:10: start.layout = \"poses\" needs start.file"},
      {"[flow]\nsource = \"file\"\n", "s.toml:2:10: flow.source = \"file\" needs flow.file"},
      {"[flow]\nfile = \"no.csv\"\n",
       "s.toml:2:8: cannot read 'no.csv': No such file or directory"},
      {"[ruleset]\nfile = \"no.rules\"\n",
       "s.toml:2:8: cannot read 'no.rules': No such file or directory"},
      {"command = 3\n",
       "s.toml:1:11: command is a list of tables, each under its own line [[command]]"},
      {"[[command]]\ndo = \"pause\"\n",
       "s.toml:1:1: command.at is missing: when, as 3600 or \"1 h\" - or command.copies, as 2"},
      {"[[command]]\nat = 1\ncopies = 1\ndo = \"ruleset\"\n",
       "s.toml:3:10: a command has either a time, at, or copies"},
      {"[[command]]\ncopies = 1.5\ndo = \"pump_power\"\n",
       "s.toml:2:10: command.copies = 1.5 is not 1, 2, 3, ..."},
      {"[[command]]\ncopies = 1\ndo = \"pause\"\n",
       "s.toml:2:10: command.copies goes with do = \"ruleset\" and \"pump_power\" only"},
      {"[[command]]\nat = 1\ndo = \"pump_power\"\n",
       "s.toml:1:1: command.power is missing: how much, as \"50 %\""},
      {"[[command]]\nat = 1\ndo = \"pump_power\"\npower = 120\n",
       "s.toml:4:9: command.power = 120 % is outside 0 .. 100 %"},
      {"[[command]]\nat = 1\n", "s.toml:1:1: command.do is missing: what, as \"pause\""},
      {"[[command]]\nat = -1\ndo = \"pause\"\n",
       "s.toml:2:6: command.at = -1 s is outside 0 .. 1e+08 s"},
      {"[[command]]\nat = \"1 m\"\n", "s.toml:2:6: command.at is a time in s; 'm' is not"},
      {"[[command]]\nat = 1\ndo = \"paus\"\n",
       "s.toml:3:6: command.do = \"paus\" is none of pause, resume, switch_off, ruleset, query, "
       "pump_power - "
       "did you mean 'pause'?"},
      {"[[command]]\nat = 1\ndo = \"pause\"\nmoduls = [1]\n",
       "s.toml:4:1: unknown key 'command.moduls' - did you mean 'modules'?"},
      {"[[command]]\nat = 1\ndo = \"pause\"\nmodules = [15]\n",
       "s.toml:4:11: command.modules names 15; modules are numbered 0 .. 14"},
      {"[[command]]\nat = 1\ndo = \"pause\"\nmodules = 1\n",
       "s.toml:4:11: command.modules is a list of module numbers, not a whole number"},
      {"[[command]]\nat = 1\ndo = \"pause\"\nfile = \"x\"\n",
       "s.toml:4:8: command.file goes with do = \"ruleset\" only"},
      {"[[command]]\nat = 1\ndo = \"ruleset\"\n",
       "s.toml:1:1: command.file is missing: the ruleset to go on with"},
      {"[[command]]\nat = 1\ndo = \"ruleset\"\nfile = \"no.rules\"\n",
       "s.toml:4:8: cannot read 'no.rules': No such file or directory"},
  };
  for (const Refusal& r : all) EXPECT_EQ(refusal(r.content), r.message) << r.content;
}

TEST_F(ScenarioTest, SyntaxErrorsHaveTheirLine) {
  EXPECT_TRUE(refusal("[tank]\nradius = = 1\n").starts_with("s.toml:2:"));
  EXPECT_TRUE(refusal("[tank]\nradius = 1\nradius = 2\n").starts_with("s.toml:3:"));
  EXPECT_TRUE(refusal("[tank\n").starts_with("s.toml:1:"));
  EXPECT_EQ(refusal("title = \"\xff\"\n").find('\n'), std::string::npos);  // one line
}

TEST_F(ScenarioTest, RefusesBadSets) {
  EXPECT_EQ(refusal("", {"tank.radius"}),
            "--set tank.radius: write --set path=value, as in --set tank.radius=0.3");
  EXPECT_EQ(refusal("", {"tank radius=3"}),
            "--set tank radius=3: 'tank radius' is not a path such as tank.radius");
  EXPECT_EQ(refusal("", {"base=x.toml"}), "--set base=x.toml: 'base' can be given in files only");
  EXPECT_EQ(refusal("", {"tank.radius=300"}),
            "--set tank.radius=300: tank.radius = 300 m is outside 0.05 .. 5 m - if this is in mm, "
            "write \"300 mm\"");
  EXPECT_EQ(refusal("", {"tank.raduis=1"}),
            "--set tank.raduis=1: unknown key 'tank.raduis' - did you mean 'radius'?");
  EXPECT_EQ(load("", {"title=7"}).title, "7");
  EXPECT_EQ(load("", {"title=two words"}).title, "two words");
  EXPECT_EQ(load("", {"tank.radius=25 cm"}).model.tank.radius, 0.25);
}

TEST_F(ScenarioTest, RefusesFilesThatDoNotFit) {
  dir_.write("r.rules", kRules);
  dir_.write("p.csv", "id,x,y,theta\n0,0,0,0\n");
  EXPECT_EQ(refusal("[start]\nfile = \"p.csv\"\n"), "p.csv: 1 poses for 15 bodies");
  dir_.write("p.csv", "id,x,y,theta\n0,0,0,nan\n");
  EXPECT_EQ(refusal("[start]\nfile = \"p.csv\"\n"),
            "p.csv:2:7: theta 'nan' is not a finite number");
  dir_.write("p.csv", "id,x,y,theta\n1,0,0,0\n");
  EXPECT_EQ(refusal("[start]\nfile = \"p.csv\"\n"), "p.csv:2:1: id '1' instead of 0");
  dir_.write("p.csv", "id,x,y,theta\n0,0,0\n");
  EXPECT_EQ(refusal("[start]\nfile = \"p.csv\"\n"), "p.csv:2:1: 3 columns instead of 4");
  dir_.write("p.csv", "x,y\n");
  EXPECT_EQ(refusal("[start]\nfile = \"p.csv\"\n"),
            "p.csv:1:1: the first line is not \"id,x,y,theta\"");
  EXPECT_EQ(refusal("[[command]]\nat = 1\ndo = \"ruleset\"\nfile = \"r.rules\"\n"),
            "command: a command replaces the ruleset, but no ruleset.file is set to begin with");
  EXPECT_EQ(refusal("[[command]]\ncopies = 1\ndo = \"pump_power\"\npower = 5\n"),
            "command: command.copies needs a ruleset.file");
  EXPECT_EQ(refusal("[flow]\nsource = \"still\"\n"
                    "[[command]]\nat = 1\ndo = \"pump_power\"\npower = 5\n"),
            "s.toml:2:10: still water has no pumps to set");
}

}  // namespace
}  // namespace lilytank
