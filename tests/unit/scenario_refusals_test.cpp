// What the loader of scenarios refuses, and how it says so.
#include "support/scenario_files.hpp"

namespace lilytank {
namespace {

using test::kRules;

class ScenarioRefusals : public test::ScenarioTest {};

struct Refusal {
  std::string content, message;
};

// Every message of the loader, once. Places count from 1.
TEST_F(ScenarioRefusals, RefusesWithPlaceAndAdvice) {
  const std::vector<Refusal> all{
      {"\n[forces.face_drag]\nK_f = 1\n",
       "s.toml:3:1: unknown key 'forces.face_drag.K_f' - did you mean 'K_F'?"},
      {"[forces.face_drga]\nK_F = 1\n",
       "s.toml:1:9: unknown key 'forces.face_drga.K_F' - did you mean 'face_drag'?"},
      {"[forces.face_drga]\n",
       "s.toml:1:9: unknown key 'forces.face_drga' - did you mean 'face_drag'?"},
      {"[[recordings]]\nfile = \"a.csv\"\n",
       "s.toml:1:3: unknown key 'recordings' - did you mean 'recording'?"},
      {"[[commands]]\nat = 1\n", "s.toml:1:3: unknown key 'commands' - did you mean 'command'?"},
      {"[experimnt]\nname = \"a\"\n",
       "s.toml:1:2: unknown key 'experimnt.name' - did you mean 'experiment'?"},
      {"bse = \"tank.toml\"\n", "s.toml:1:1: unknown key 'bse' - did you mean 'base'?"},
      {"[study]\nname = \"a\"\n",
       "s.toml:1:2: [study] is not of a scenario, but of the file of a study: for lilytank study"},
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
      {"[control]\ncapture_distance = \"2 cm\"\n",
       "s.toml:2:20: control.capture_distance = 0.02 m is more than half of module.side = 0.035 m: "
       "faces would latch across a module"},
      {"[forces.empirical_force]\nlow = 2\nhigh = 2\n",
       "s.toml:3:8: forces.empirical_force.high: it must be above low"},
      {"[forces.heterogeneous_module]\nextra = 0.5\nmodule = 15\n",
       "s.toml:3:10: forces.heterogeneous_module.module: there are only 15, counted from 0"},
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

TEST_F(ScenarioRefusals, SyntaxErrorsHaveTheirLine) {
  EXPECT_TRUE(refusal("[tank]\nradius = = 1\n").starts_with("s.toml:2:"));
  EXPECT_TRUE(refusal("[tank]\nradius = 1\nradius = 2\n").starts_with("s.toml:3:"));
  EXPECT_TRUE(refusal("[tank\n").starts_with("s.toml:1:"));
  EXPECT_EQ(refusal("title = \"\xff\"\n").find('\n'), std::string::npos);  // one line
}

TEST_F(ScenarioRefusals, RefusesBadSets) {
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
  EXPECT_EQ(refusal("", {"modul.count=3"}),
            "--set modul.count=3: unknown key 'modul.count' - did you mean 'module.count'?");
  EXPECT_EQ(refusal("", {"modul.cuont=3"}),
            "--set modul.cuont=3: unknown key 'modul.cuont' - did you mean 'module.count'?");
  EXPECT_EQ(load("", {"title=7"}).title, "7");
  EXPECT_EQ(load("", {"title=two words"}).title, "two words");
  EXPECT_EQ(load("", {"tank.radius=25 cm"}).model.tank.radius, 0.25);
}

TEST_F(ScenarioRefusals, RefusesFilesThatDoNotFit) {
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
            "p.csv:1:1: there is no column 'id'; a file of poses has the columns id,x,y,theta");
  EXPECT_EQ(refusal("[[command]]\nat = 1\ndo = \"ruleset\"\nfile = \"r.rules\"\n"),
            "command: a command replaces the ruleset, but no ruleset.file is set to begin with");
  EXPECT_EQ(refusal("[[command]]\ncopies = 1\ndo = \"pump_power\"\npower = 5\n"),
            "command: command.copies needs a ruleset.file");
  EXPECT_EQ(refusal("[flow]\nsource = \"still\"\n"
                    "[[command]]\nat = 1\ndo = \"pump_power\"\npower = 5\n"),
            "s.toml:2:10: still water has no pumps to set");
}

// The grid is square about the centre in any unit; only the tank and speeds tell which one it is
// in.
TEST_F(ScenarioRefusals, RefusesFlowsInOtherUnits) {
  const auto with = [&](const std::string& edge, const std::string& first) {
    const std::string rest = ",0.1,0,0,0,1\n";
    dir_.write("f.csv",
               "ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,measured\n0,0,-" +
                   edge + ",-" + edge + "," + first + "\n1,0," + edge + ",-" + edge + rest +
                   "0,1,-" + edge + "," + edge + rest + "1,1," + edge + "," + edge + rest);
    return refusal("[flow]\nfile = \"f.csv\"\n");
  };
  const std::string slow = "0.1,0,0,0,1";
  const std::string reach = "f.csv: the flow grid reaches ";
  const std::string of = " m to every side of the centre of a tank of radius 0.3 m";
  EXPECT_EQ(with("15", slow), reach + "30" + of + ": are x_m and y_m in cm?");
  EXPECT_EQ(with("150", slow), reach + "300" + of + ": are x_m and y_m in mm?");
  EXPECT_EQ(with("1.5", slow), reach + "3" + of);
  EXPECT_EQ(with("0.02", slow), reach + "0.04" + of);
  const std::string fast = " m/s is faster than 5 m/s: are these velocities in cm/s or mm/s?";
  EXPECT_EQ(with("0.15", "10.2,0,0,0,1"), "f.csv:2:17: mean_vx_mps = 10.2" + fast);
  EXPECT_EQ(with("0.15", "0,-10.2,0,0,1"), "f.csv:2:19: mean_vy_mps = -10.2" + fast);
  EXPECT_EQ(with("0.15", "0,0,0,12,1"), "f.csv:2:23: std_vy_mps = 12" + fast);
  for (const char* edge : {"0.05", "0.15", "0.6"}) EXPECT_EQ(with(edge, slow), "(accepted)");
  EXPECT_EQ(with("0.15", "999,0,0,0,0"), "(accepted)");  // of a cell that does not count
}

}  // namespace
}  // namespace lilytank
