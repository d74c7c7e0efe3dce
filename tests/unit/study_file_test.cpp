// What a study file may say, what it becomes, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "study/study_record.hpp"
#include "support/study_rig.hpp"

namespace lilytank {
namespace {

using Texts = std::vector<std::string>;

const std::string kStudyHead = "[study]\nscenario = \"pair.toml\"\nreplicates = 3\n";

class StudyFileTest : public testing::Test, public test::StudyRig {
 protected:
  static Texts labels(const Study& study) {
    Texts out;
    for (const Setting& setting : study.plan().settings) out.push_back(setting.label);
    return out;
  }
  void expect(const std::string& rest, const std::string& message) const {
    EXPECT_EQ(refusal(kStudyHead + rest), message) << rest;
  }
};

TEST_F(StudyFileTest, WithoutAxesThereIsOneSetting) {
  const Study study = this->study("[study]\nscenario = \"pair.toml\"\nreplicates = 3\nseed = 9\n");
  const StudyPlan& plan = study.plan();
  EXPECT_EQ(plan.name, "study");  // of the file
  EXPECT_EQ(plan.seed, 9u);
  EXPECT_EQ(plan.replicates, 3);
  EXPECT_FALSE(plan.stop);
  ASSERT_EQ(plan.settings.size(), 1u);
  EXPECT_EQ(plan.settings[0].label, "study");
  EXPECT_EQ(plan.settings[0].duration, 8);
  EXPECT_EQ(plan.horizon(), 8);
  EXPECT_EQ(study.scenario(0).model.module.count, 6);
}

TEST_F(StudyFileTest, SettingsAreTheProductOfTheAxes) {
  const Study study =
      this->study(kStudyHead +
                  "[[axis]]\npath = \"module.count\"\nvalues = [4, 6]\n"
                  "[[axis]]\nname = \"rules\"\noverlays = [\"sticky.toml\", \"loose.toml\"]\n"
                  "[[axis]]\npath = \"tank.radius\"\nvalues = [\"16 cm\", 0.2, \"25 cm\"]\n");
  EXPECT_EQ(study.plan().axes, (Texts{"module.count", "rules", "tank.radius"}));
  ASSERT_EQ(study.plan().settings.size(), 12u);
  EXPECT_EQ(labels(study)[0], "count=4, rules=sticky, radius=16 cm");
  EXPECT_EQ(labels(study)[1], "count=4, rules=sticky, radius=0.2");  // the last axis is fastest
  EXPECT_EQ(labels(study)[3], "count=4, rules=loose, radius=16 cm");
  EXPECT_EQ(labels(study)[11], "count=6, rules=loose, radius=25 cm");
  const Setting& last = study.plan().settings[11];
  EXPECT_EQ(last.texts, (Texts{"6", "loose", "0.25"}));
  EXPECT_EQ(last.values, (std::vector<double>{6, 1, 0.25}));
  const Scenario scenario = study.scenario(11);
  EXPECT_EQ(scenario.model.module.count, 6);
  EXPECT_EQ(scenario.model.tank.radius, 0.25);
  EXPECT_EQ(scenario.model.rulesets[0].rules[1].p, 1);
  EXPECT_EQ(scenario.identity, last.identity);
}

TEST_F(StudyFileTest, RangesAreLinearOrLogarithmic) {
  const auto texts = [&](const std::string& axis) {
    Texts out;
    const Study read = study(kStudyHead + "[[axis]]\n" + axis);
    for (const Setting& s : read.plan().settings) out.push_back(s.texts[0]);
    return out;
  };
  EXPECT_EQ(texts("path = \"contact.friction\"\nfrom = 0.1\nto = 0.5\ncount = 5\n"),
            (Texts{"0.1", "0.2", "0.3", "0.4", "0.5"}));
  EXPECT_EQ(texts("path = \"rules.part.p\"\nfrom = 1e-4\nto = 1\ncount = 5\nscale = \"log\"\n"),
            (Texts{"1e-04", "0.001", "0.01", "0.1", "1"}));
  EXPECT_EQ(texts("path = \"module.count\"\nfrom = 3\nto = 6\ncount = 3\n"),
            (Texts{"3", "5", "6"}));  // rounded
  EXPECT_EQ(texts("path = \"tank.radius\"\nfrom = \"16 cm\"\nto = \"14 cm\"\ncount = 3\n"),
            (Texts{"0.16", "0.15", "0.14"}));
}

TEST_F(StudyFileTest, ValuesAreInTheUnitsOfTheirKeysAndLabelsAsWritten) {
  const auto only = [&](const std::string& path, const std::string& value) {
    return study(kStudyHead + "[[axis]]\npath = \"" + path + "\"\nvalues = [\"" + value + "\"]\n")
        .plan()
        .settings.at(0);
  };
  const auto expect = [&](const Setting& s, const std::string& text, double value,
                          const std::string& label) {
    EXPECT_EQ(s.texts, Texts{text});
    EXPECT_EQ(s.values, std::vector<double>{value});
    EXPECT_EQ(s.label, label);
  };
  expect(only("run.duration", "0.01 h"), "36", 36, "duration=0.01 h");
  expect(only("module.mass", "60 g"), "0.06", 0.06, "mass=60 g");
  expect(only("forces.stochastic.sigma_stoch", "1 mN"), "0.001", 0.001,
         "stochastic.sigma_stoch=1 mN");
  expect(only("rules.part.p", "2 %"), "0.02", 0.02, "part.p=2 %");
  expect(only("flow.pump_power", "60 %"), "60", 60, "pump_power=60 %");
  expect(only("flow.gusts", "per_module"), "per_module", 0, "gusts=per_module");
}

TEST_F(StudyFileTest, LabelsAndNamesAreOnesOwn) {
  const Study study =
      this->study(kStudyHead +
                  "[[axis]]\nname = \"p\"\npath = \"rules.part.p\"\nvalues = [0, 1]\n"
                  "labels = [\"never\", \"at once\"]\n");
  EXPECT_EQ(labels(study), (Texts{"p=never", "p=at once"}));
  EXPECT_EQ(study.plan().axes, Texts{"p"});
  EXPECT_EQ(labels(this->study(kStudyHead + "[[axis]]\npath = \"rules.part.p\"\nvalues = [0]\n")),
            Texts{"part.p=0"});
  const std::string overlays =
      kStudyHead + "[[axis]]\nname = \"rules\"\noverlays = [\"sticky.toml\", \"loose.toml\"]\n";
  EXPECT_EQ(labels(this->study(overlays)), (Texts{"rules=sticky", "rules=loose"}));
  EXPECT_EQ(labels(this->study(overlays + "labels = [\"by hand\", \"as found\"]\n")),
            (Texts{"by hand", "as found"}));
}

TEST_F(StudyFileTest, SetsLieOnTopOfEverySetting) {
  const Study study = this->study(
      kStudyHead + "[[axis]]\nname = \"rules\"\noverlays = [\"sticky.toml\", \"loose.toml\"]\n",
      {"rules.join.p=0.5", "run.duration=3"});
  for (int s = 0; s < 2; ++s) {
    EXPECT_EQ(study.scenario(s).duration, 3);
    EXPECT_EQ(study.scenario(s).model.rulesets[0].rules[0].p, 0.5);
  }
  const std::string axis = "[[axis]]\npath = \"module.count\"\nvalues = [4, 6]\n";
  EXPECT_EQ(refusal(kStudyHead + axis, {"module.count=5"}),
            "--set module.count=5: 'module.count' is an axis of the study, see study.toml:4:1");
  EXPECT_EQ(this->study(kStudyHead, {"run.seed=5"}).plan().seed, 5u) << "that of the study";
  EXPECT_EQ(refusal(kStudyHead, {"run.seed=-5"}),
            "--set run.seed=-5: run.seed = -5 is outside 0 .. 1e+18");
  EXPECT_EQ(refusal(kStudyHead, {"module.cuont=5"}),
            "--set module.cuont=5: unknown key 'module.cuont' - did you mean 'count'?");
}

TEST_F(StudyFileTest, LatinHypercubesFillEveryPartOnce) {
  const int n = 40;
  const std::string head = "[study]\nscenario = \"pair.toml\"\nreplicates = 1\nsamples = 40\n";
  const Study study = this->study(
      head +
      "[[axis]]\npath = \"contact.friction\"\nlatin = {from = 0.2, to = 1}\n"
      "[[axis]]\npath = \"rules.part.p\"\nlatin = {from = 1e-3, to = 1, scale = \"log\"}\n"
      "[[axis]]\npath = \"module.count\"\nvalues = [4, 5]\n");
  ASSERT_EQ(study.plan().settings.size(), 80u);  // the whole hypercube for each other value
  for (const int half : {0, 1}) {
    std::set<int> parts[2];
    bool sorted = true, equal = true;
    int before = -1;
    for (int i = 0; i < n; ++i) {
      const Setting& s = study.plan().settings[static_cast<std::size_t>(half * n + i)];
      EXPECT_EQ(s.values[2], half == 0 ? 4 : 5);
      const int a = static_cast<int>((s.values[0] - 0.2) / 0.8 * n);
      const int b = static_cast<int>((std::log10(s.values[1]) + 3) / 3 * n);
      parts[0].insert(a), parts[1].insert(b);
      sorted = sorted && a > before, equal = equal && a == b;
      before = a;
    }
    for (const auto& axis : parts) {
      EXPECT_EQ(axis.size(), 40u);
      EXPECT_EQ(*axis.begin(), 0);
      EXPECT_EQ(*axis.rbegin(), n - 1);
    }
    EXPECT_FALSE(sorted);  // in random order,
    EXPECT_FALSE(equal);   // another one for each axis
  }
  EXPECT_EQ(refusal("[study]\nscenario = \"pair.toml\"\nreplicates = 1\n[[axis]]\n"
                    "path = \"contact.friction\"\nlatin = {from = 0.2, to = 1}\n"),
            "study.toml:1:1: study.samples is missing: how many points of the latin hypercube");
  EXPECT_EQ(refusal(head), "study.toml:4:11: study.samples goes with an axis that has latin");
}

TEST_F(StudyFileTest, IdsAreOfScenarioAndSeedOnly) {
  const std::string axis = "[[axis]]\npath = \"module.count\"\nvalues = ";
  const StudyPlan a = study(kStudyHead + axis + "[4, 6]\n").plan();
  const StudyPlan b = study("[study]\nname = \"b\"\nscenario = \"pair.toml\"\nreplicates = 90\n" +
                            axis + "[5, 4]\n")
                          .plan();
  EXPECT_EQ(a.id_of(0, 2), b.id_of(1, 2));
  EXPECT_EQ(a.id_of(0, 2).size(), 16u);
  std::set<std::string> ids;
  for (int s = 0; s < 2; ++s) {
    for (int r = 0; r < 100; ++r) ids.insert(a.id_of(s, r)), ids.insert(b.id_of(s, r));
  }
  EXPECT_EQ(ids.size(), 300u);
  EXPECT_EQ(a.seed_of(7), b.seed_of(7));
  EXPECT_NE(a.seed_of(7), a.seed_of(8));
  for (int r = 0; r < 1000; ++r) EXPECT_LT(a.seed_of(r), std::uint64_t{1} << 59);
  StudyPlan other = a;
  other.seed = 2;
  EXPECT_NE(other.id_of(0, 2), a.id_of(0, 2));
}

TEST_F(StudyFileTest, IdentityIsOfTheRunsNotOfTheirNumber) {
  const std::string axis = "[[axis]]\npath = \"module.count\"\nvalues = [4, 6]\n";
  const std::string scenario = "[study]\nscenario = \"pair.toml\"\n";
  const std::uint64_t first = study(kStudyHead + axis).plan().identity();
  EXPECT_EQ(study(scenario + "replicates = 50\nname = \"x\"\n" + axis).plan().identity(), first);
  EXPECT_NE(study(scenario + "replicates = 3\nseed = 2\n" + axis).plan().identity(), first);
  EXPECT_NE(study(kStudyHead + axis, {"run.duration=9"}).plan().identity(), first);
  EXPECT_NE(
      study(kStudyHead + "[[axis]]\npath = \"module.count\"\nvalues = [6, 4]\n").plan().identity(),
      first);
}

TEST_F(StudyFileTest, PlansAreStoredAndReadBack) {
  const StudyPlan plan =
      study(
          "[study]\nname = \"x\"\nscenario = [\"pair.toml\", \"loose.toml\"]\nseed = 3\n"
          "[stop]\nmetric = \"time_2\"\nhalf_width = \"1 min\"\nmin = 4\nmax = 30\nround = 7\n"
          "[[axis]]\npath = \"flow.gusts\"\nvalues = [\"per_point\", \"per_module\"]\n",
          {"title=\"a \\\"b\\\"\""})
          .plan();
  const std::string text = plan_text(plan);
  const StudyPlan back = read_plan(here.write("plan.toml", text));
  EXPECT_EQ(plan_text(back), text);
  EXPECT_EQ(back.identity(), plan.identity());
  EXPECT_EQ(back.stop->half_width, 60);
  EXPECT_EQ(back.settings[1].texts, Texts{"per_module"});
  EXPECT_EQ(back.settings[1].values, std::vector<double>{1});
  std::string changed = text;
  changed.replace(changed.find("seed = 3"), 8, "seed = 4");
  EXPECT_THROW(read_plan(here.write("plan.toml", changed)), InputError);
}

TEST_F(StudyFileTest, MistakesInTheHead) {
  EXPECT_EQ(refusal("[studdy]\n"), "study.toml:1:2: unknown key 'studdy' - did you mean 'study'?");
  EXPECT_EQ(refusal(""), "study.toml:1:1: there is no [study] table");
  EXPECT_EQ(refusal("study = 3\n"), "study.toml:1:9: study is a table, under the line [study]");
  EXPECT_EQ(refusal("[study]\nreplicates = 3\n"),
            "study.toml:1:1: study.scenario is missing: a scenario file, or a list with its "
            "overlays");
  EXPECT_EQ(refusal("[study]\nscenario = \"nobody.toml\"\n"),
            "study.toml:2:12: cannot read 'nobody.toml': No such file or directory");
  EXPECT_EQ(
      refusal("[study]\nscenario = \"pair.toml\"\n"),
      "study.toml:1:1: study.replicates is missing: the number of simulations of each setting");
  EXPECT_EQ(refusal(kStudyHead + "sede = 3\n"),
            "study.toml:4:1: unknown key 'study.sede' - did you mean 'seed'?");
  EXPECT_EQ(refusal(kStudyHead + "seed = 1.5\n"),
            "study.toml:4:8: study.seed is a whole number, not a number");
  EXPECT_EQ(refusal(kStudyHead + "seed = -1\n"),
            "study.toml:4:8: study.seed = -1 is outside 0 .. 1000000000000000000");
  EXPECT_EQ(refusal(kStudyHead + "name = \"a/b\"\n"),
            "study.toml:4:8: study.name = \"a/b\" is not of letters, digits, '_', '-' and '.': it "
            "names files and columns");
}

TEST_F(StudyFileTest, MistakesInTheStoppingRule) {
  const std::string head = "[study]\nscenario = \"pair.toml\"\n[stop]\n";
  EXPECT_EQ(refusal(head + "metric = \"copeis\"\n"),
            "study.toml:4:10: unknown metric 'copeis' - there are copies, full_yield, "
            "assembly_rate, time_1, time_2, ... - did you mean 'copies'?");
  EXPECT_EQ(refusal(head + "metric = \"copies\"\n"),
            "study.toml:3:1: stop.half_width is missing: how narrow: half of the 95 % interval");
  EXPECT_EQ(refusal(head + "metric = \"copies\"\nhalf_width = 0\n"),
            "study.toml:5:14: stop.half_width = 0 is not above 0");
  EXPECT_EQ(refusal(head + "metric = \"copies\"\nhalf_width = 0.1\n"),
            "study.toml:3:1: stop.max is missing: the most replicates of a setting");
  EXPECT_EQ(refusal(head + "metric = \"time_1\"\nhalf_width = \"2 m\"\nmax = 20\n"),
            "study.toml:5:14: stop.half_width is a time in s; 'm' is not");
  EXPECT_EQ(refusal(kStudyHead + "[stop]\nmetric = \"copies\"\nhalf_width = 0.1\nmax = 20\n"),
            "study.toml:3:14: study.replicates is a fixed number; with [stop] give stop.max "
            "instead");
}

// A time that is never told never becomes narrow: the most replicates would be run for nothing.
TEST_F(StudyFileTest, StoppingRulesAskForCopiesThatThereCanBe) {
  const auto with = [&](const std::string& metric, const std::string& rest) {
    return refusal("[study]\nscenario = \"pair.toml\"\n[stop]\nmetric = \"" + metric +
                   "\"\nhalf_width = 1\nmax = 20\n" + rest);
  };
  const std::string axis = "[[axis]]\npath = \"module.count\"\nvalues = [6, 3]\n";
  EXPECT_EQ(with("time_3", ""), "(accepted)");
  EXPECT_EQ(with("time_1", axis), "(accepted)");
  EXPECT_EQ(with("time_99", ""),
            "study.toml:4:10: stop.metric = \"time_99\", but in 'study' there are 6 modules: "
            "enough for 3 copies");
  EXPECT_EQ(with("time_2", axis),
            "study.toml:4:10: stop.metric = \"time_2\", but in 'count=3' there are 3 modules: "
            "enough for 1 copy");
  here.write("alone.toml", "[ruleset]\nfile = \"\"\n");
  const std::string bare = "[[axis]]\nname = \"rules\"\noverlays = [\"alone.toml\"]\n";
  EXPECT_EQ(with("copies", bare), "(accepted)");
  EXPECT_EQ(with("full_yield", bare),
            "study.toml:4:10: stop.metric = \"full_yield\", but in 'rules=alone' there are 6 "
            "modules: enough for 0 copies");
}

// Two columns of one name cannot be told apart by who reads the tables.
TEST_F(StudyFileTest, AxesHaveNamesOfTheirOwn) {
  const std::string axis = "path = \"rules.part.p\"\nvalues = [0, 1]\n";
  for (const char* name : {"seed", "setting", "status", "replicate", "id", "label", "k", "value",
                           "time_s", "time_12_s"}) {
    expect("[[axis]]\nname = \"" + std::string(name) + "\"\n" + axis,
           "study.toml:5:8: axis.name = \"" + std::string(name) +
               "\" is that of another column of the study's tables: give another one");
  }
  for (const char* name : {"seeds", "time__s", "time_a_s", "time_3"}) {
    expect("[[axis]]\nname = \"" + std::string(name) + "\"\n" + axis, "(accepted)");
  }
}

TEST_F(StudyFileTest, MistakesInAxes) {
  expect("[[axis]]\npath = \"module.cuont\"\nvalues = [3]\n",
         "study.toml:5:8: unknown key 'module.cuont' - did you mean 'count'?");
  expect("[[axis]]\npath = \"module.cuont\"\nfrom = 3\nto = 4\ncount = 2\n",
         "study.toml:5:8: unknown key 'module.cuont' - did you mean 'count'?");
  expect("[[axis]]\npath = \"module.count\"\nvalues = [3, 4.5]\n",
         "study.toml:6:14: module.count is a whole number; 4.5 is not");
  expect("[[axis]]\npath = \"tank.radius\"\nvalues = [0.16, \"16 s\"]\n",
         "study.toml:6:17: tank.radius is a length in m; 's' is not");
  expect("[[axis]]\npath = \"tank.radius\"\nvalues = []\n",
         "study.toml:6:10: axis.values is a list with at least one value");
  expect("[[axis]]\npath = \"tank.radius\"\nvalue = [1]\n",
         "study.toml:6:1: unknown key 'axis.value' - did you mean 'values'?");
  expect("[[axis]]\npath = \"tank.radius\"\n",
         "study.toml:4:1: an axis needs values, from and to and count, latin, or overlays");
  expect("[[axis]]\npath = \"tank.radius\"\nfrom = 0.2\nto = 0.3\n",
         "study.toml:4:1: axis.count is missing: how many values");
  expect("[[axis]]\npath = \"tank.radius\"\nfrom = 0\nto = 1\ncount = 3\nscale = \"log\"\n",
         "study.toml:6:8: scale = \"log\" needs ends above 0");
  expect("[[axis]]\npath = \"tank.radius\"\nfrom = 0.2\nto = 1\ncount = 3\nscale = \"lag\"\n",
         "study.toml:9:9: axis.scale = \"lag\" is none of linear, log - did you mean 'log'?");
  expect("[[axis]]\npath = \"flow.gusts\"\nfrom = 0\nto = 1\ncount = 2\n",
         "study.toml:5:8: 'flow.gusts' is not a number: list its values");
  expect("[[axis]]\npath = \"tank.radius\"\nvalues = [1]\nlatin = {from = 1, to = 2}\n",
         "study.toml:7:9: axis.latin goes not with axis.values");
  expect("[[axis]]\npath = \"run.seed\"\nvalues = [1]\n",
         "study.toml:5:8: 'run.seed' is no axis: replicates have seeds of their own, see "
         "study.seed and study.replicates");
  expect("[[axis]]\noverlays = [\"sticky.toml\"]\n",
         "study.toml:4:1: axis.name is missing: what the overlays differ in, for tables");
  expect("[[axis]]\nname = \"p\"\noverlays = [\"stikcy.toml\"]\n",
         "cannot read 'stikcy.toml': No such file or directory - did you mean 'sticky.toml'?");
  const std::string count = "[[axis]]\npath = \"module.count\"\nvalues = [4, 4]\n";
  expect(count, "study.toml: settings 'count=4' and 'count=4' are one and the same scenario");
  expect("[[axis]]\npath = \"module.count\"\nvalues = [3]\n" + count,
         "study.toml:7:1: there is an axis 'module.count' already");
  expect("[[axis]]\npath = \"module.count\"\nvalues = [3]\nlabels = [\"a\", \"b\"]\n",
         "study.toml:7:10: axis.labels has 2 texts for 1 values");
  EXPECT_NE(refusal(kStudyHead + "[[axis]]\npath = \"module.count\"\nvalues = [4, 400]\n")
                .find("count=400: "),
            std::string::npos);
}

}  // namespace
}  // namespace lilytank
