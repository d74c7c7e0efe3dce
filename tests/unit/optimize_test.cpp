// Optimisation: what a run is worth, what a point means, interruption, refusals.
#include "lilytank/optimize.hpp"

#include <gtest/gtest.h>

#include "lilytank/assembly_record.hpp"
#include "lilytank/random.hpp"
#include "optimize/comparison.hpp"
#include "study/run_world.hpp"
#include "support/optimize_rig.hpp"

namespace lilytank::test {
namespace {

constexpr double kHour = 3600;

double value(Fitness fitness, const std::vector<double>& completion, int possible = 3,
             double horizon = 4 * kHour) {
  return fitness_of({fitness, 600, 1}, completion, possible, horizon);
}

// By hand, for three copies in four hours.
TEST(Fitness, EqTenAddsUpTheTimesBetweenCopies) {
  EXPECT_DOUBLE_EQ(value(Fitness::eq10, {}), 3 * 14400);
  EXPECT_DOUBLE_EQ(value(Fitness::eq10, {1000}), 1000 + 2 * 14400);
  // The times between copies telescope: t_k + (N - k) T.
  EXPECT_DOUBLE_EQ(value(Fitness::eq10, {1000, 1500}), 1500 + 14400);
  EXPECT_DOUBLE_EQ(value(Fitness::eq10, {1000, 1500, 9000}), 9000);
}

TEST(Fitness, AreaTimeAndProbability) {
  EXPECT_DOUBLE_EQ(value(Fitness::yield_area, {}), 3 * 14400);
  EXPECT_DOUBLE_EQ(value(Fitness::yield_area, {1000, 1500}), 1000 + 1500 + 14400);
  EXPECT_DOUBLE_EQ(value(Fitness::full_yield_time, {1000, 1500}), 14400);
  EXPECT_DOUBLE_EQ(value(Fitness::full_yield_time, {1000, 1500, 9000}), 9000);
  EXPECT_DOUBLE_EQ(value(Fitness::full_yield_probability, {1000, 1500}), 1);
  EXPECT_DOUBLE_EQ(value(Fitness::full_yield_probability, {1000, 1500, 9000}), 0);
}

TEST(Fitness, RateAndYieldAreWeighed) {
  EXPECT_DOUBLE_EQ(value(Fitness::rate_and_yield, {}), 1);
  EXPECT_DOUBLE_EQ(value(Fitness::rate_and_yield, {1000, 1500}), 1.0 / 3 - 600 * 2 / 14400.0);
  EXPECT_DOUBLE_EQ(value(Fitness::rate_and_yield, {1000, 1500, 9000}), -600 * 3 / 9000.0);
}

std::vector<double> completion_of(const Scenario& scenario, std::uint64_t seed, EarlyEnd early) {
  return run_world(scenario, seed, early).row.completion;
}

// Worlds of 60 s: most reach their three pairs, which part again.
TEST(Optimize, AWorldLeftEarlyIsWorthWhatTheWholeOneIs) {
  const OptimizeRig rig;
  const Optimization what = rig.read(kHead + kPart, {"run.duration=60"});
  int full = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Scenario scenario = what.scenario({0.05});
    const auto whole = completion_of(scenario, seed, EarlyEnd::never);
    const auto early = completion_of(scenario, seed, EarlyEnd::completed);
    full += whole.size() == 3;
    for (int f = 0; f < 5; ++f) {
      const FitnessRule rule{static_cast<Fitness>(f)};
      EXPECT_EQ(fitness_of(rule, whole, 3, 60), fitness_of(rule, early, 3, 60)) << seed;
    }
  }
  EXPECT_GT(full, 2);
}

TEST(Optimize, ASettledWorldHasTheRowOfTheWholeOne) {
  const OptimizeRig rig;
  for (const double p : {0.0, 0.05}) {
    const Scenario scenario = rig.read(kHead + kPart, {"run.duration=60"}).scenario({p});
    double spared = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const auto whole = run_world(scenario, seed, EarlyEnd::never);
      const auto early = run_world(scenario, seed, EarlyEnd::settled);
      EXPECT_EQ(whole.row.completion, early.row.completion);
      EXPECT_EQ(whole.row.copies, early.row.copies);
      EXPECT_EQ(whole.row.duration, early.row.duration);
      EXPECT_EQ(whole.row.illegal, early.row.illegal);
      spared += whole.simulated - early.simulated;
    }
    // Pairs that may part are not settled.
    EXPECT_EQ(spared > 0, p == 0) << spared;
  }
}

// A target that is still to come begins its copies anew.
TEST(Optimize, AWorldThatAwaitsAnotherTargetIsNotSettled) {
  const OptimizeRig rig;
  Scenario scenario = rig.read(kHead + kPart, {"run.duration=60"}).scenario({0});
  Ruleset other = scenario.model.rulesets.front();
  other.target = {{0, 0}, {1, 0}, {2, 0}};
  scenario.model.rulesets.push_back(other);
  Command change;
  change.at = 59, change.kind = CommandKind::replace_ruleset, change.ruleset = 1;
  const bool feedback[] = {false, true};
  for (const bool by_copies : feedback) {
    change.copies = by_copies ? 3 : 0;
    scenario.model.commands.clear(), scenario.model.feedback.clear();
    (by_copies ? scenario.model.feedback : scenario.model.commands).push_back(change);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const auto whole = run_world(scenario, seed, EarlyEnd::never);
      for (const EarlyEnd early : {EarlyEnd::settled, EarlyEnd::completed}) {
        const auto other_row = run_world(scenario, seed, early);
        EXPECT_EQ(whole.row.completion, other_row.row.completion) << seed;
        EXPECT_EQ(whole.row.copies, other_row.row.copies) << seed;
      }
    }
  }
}

TEST(Optimize, AStudyUntilSettledHasTheSameTable) {
  const OptimizeRig rig;
  const std::string study =
      "[study]\nscenario = [\"pair.toml\", \"sticky.toml\"]\nreplicates = 6\n";
  std::string tables[2];
  for (int settled = 0; settled < 2; ++settled) {
    StudyOptions options;
    options.out = rig.here.path("out" + std::to_string(settled));
    const Study read =
        rig.study(study + (settled == 1 ? "until = \"settled\"\n" : ""), {"run.duration=60"});
    run_study(read, options);
    tables[settled] = table_text(load_study(options.out));
  }
  EXPECT_EQ(tables[0], tables[1]);
  EXPECT_NE(rig.refusal(study + "until = \"setled\"\n").find("did you mean 'settled'?"),
            std::string::npos);
}

TEST(Optimize, AHybridHasTwoSetsAndASwitch) {
  const OptimizeRig rig;
  const Optimization what = rig.read(kHead + "hybrid = true\n" + kPart);
  ASSERT_EQ(what.plan().space.size(), 3u);
  EXPECT_EQ(what.plan().space[0].name, "rules.part.p");
  EXPECT_EQ(what.plan().space[1].name, "after.rules.part.p");
  EXPECT_EQ(what.plan().space[2].name, "after.copies");
  EXPECT_EQ(what.plan().start, (std::vector<double>{0.5, 0.5, 2}));
  for (const auto& [x, copies] : {std::pair{1.0, 1}, {1.99, 1}, {2.0, 2}, {3.0, 2}}) {
    const Scenario scenario = what.scenario({0.9, 0.01, x});
    ASSERT_EQ(scenario.model.rulesets.size(), 2u);
    EXPECT_EQ(scenario.model.rulesets[0].rules[1].p, 0.9);
    EXPECT_EQ(scenario.model.rulesets[1].rules[1].p, 0.01);
    ASSERT_EQ(scenario.model.feedback.size(), 1u);
    EXPECT_EQ(scenario.model.feedback[0].kind, CommandKind::replace_ruleset);
    EXPECT_EQ(scenario.model.feedback[0].ruleset, 1);
    EXPECT_EQ(scenario.model.feedback[0].copies, copies);
  }
}

TEST(Optimize, AgitationFollowsCopiesOrTime) {
  const OptimizeRig rig;
  const std::string bounds = "low = \"40 %\"\nhigh = \"90 %\"\n";
  const Optimization by_copies = rig.read(kHead + "[agitation]\nkind = \"feedback\"\n" + bounds);
  ASSERT_EQ(by_copies.plan().space.size(), 3u);
  const Scenario scenario = by_copies.scenario({70.4, 50.6, 69.6});
  ASSERT_EQ(scenario.model.feedback.size(), 2u);
  EXPECT_EQ(scenario.model.feedback[0].copies, 1);
  EXPECT_EQ(scenario.model.feedback[0].field, 1);  // 51 %
  EXPECT_EQ(scenario.model.feedback[1].field, 0);  // 70 %, as at the start
  const Optimization by_time =
      rig.read(kHead + "[agitation]\nkind = \"schedule\"\npieces = 3\n" + bounds);
  const Scenario timed = by_time.scenario({70, 50, 60, 6, 2});
  ASSERT_EQ(timed.model.commands.size(), 2u);
  EXPECT_EQ(timed.model.commands[0].at, 2);
  EXPECT_EQ(timed.model.commands[1].at, 6);
}

/// The whole run of a point's world in a search with seed 1.
WorldRun whole_of(const Optimization& what, const Trial& trial) {
  const auto seed = derived_seed(1, static_cast<std::uint64_t>(trial.replicate)) >> 5;
  return run_world(what.scenario(trial.point), seed, EarlyEnd::never);
}

// Four modules make two pairs, whatever the scenario's six would make; a horizon is a world's own.
TEST(Optimize, CopiesAndHorizonAreTheWorldsOwn) {
  const OptimizeRig rig;
  const Optimization count = rig.read(
      kHead + "[[parameter]]\npath = \"module.count\"\nlow = 4\nhigh = 6\n", {"run.duration=60"});
  const Optimization duration =
      rig.read(kHead + "[[parameter]]\npath = \"run.duration\"\nlow = 2\nhigh = 60\n");
  const FitnessRule rule;
  int full = 0;
  for (std::int64_t replicate = 0; replicate < 12; ++replicate) {
    for (const double modules : {4.0, 6.0}) {
      const Trial few{{modules}, replicate};
      const auto completion = whole_of(count, few).row.completion;
      const int possible = static_cast<int>(modules) / 2;
      EXPECT_EQ(count.evaluate(few), fitness_of(rule, completion, possible, 60));
      full += completion.size() == 2 && modules < 6;
    }
    const Trial brief{{2}, replicate}, lengthy{{60}, replicate};
    EXPECT_EQ(duration.evaluate(brief),
              fitness_of(rule, whole_of(duration, brief).row.completion, 3, 2));
    EXPECT_EQ(duration.evaluate(lengthy),
              fitness_of(rule, whole_of(duration, lengthy).row.completion, 3, 60));
  }
  EXPECT_GT(full, 0);
  EXPECT_NE(rig.refused(kHead + "[[parameter]]\npath = \"module.count\"\nlow = 1\nhigh = 6\n")
                .find("optimize.toml: 1 modules make no copy of 2"),
            std::string::npos);
}

// The overlay that is written makes the very worlds that were searched.
TEST(Optimize, TheOverlayIsThePoint) {
  const OptimizeRig rig;
  const Optimization what = rig.read(
      kHead + "hybrid = true\n" + kPart + "[agitation]\nkind = \"feedback\"\nlow = 40\nhigh = 90\n",
      {"run.duration=30"});
  const std::vector<double> point{0.123456789, 0.0234567, 1.5, 71.2, 55, 43};
  for (const auto& file : what.overlay(point, "best", "One.\nTwo.")) {
    rig.here.write(file.name, file.content);
  }
  EXPECT_TRUE(rig.here.read("best.toml").starts_with("# One.\n# Two.\n"));
  const Scenario read =
      load_scenario({rig.here.path("pair.toml"), rig.here.path("best.toml")}, {"run.duration=30"});
  const Scenario searched = what.scenario(point);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    World a(read.model, seed), b(searched.model, seed);
    for (int step = 0; step < 1200; ++step) a.step(), b.step();
    EXPECT_EQ(fingerprint(a.state()), fingerprint(b.state())) << seed;
  }
}

TEST(Optimize, StoppedAnywhereItEndsInTheSameFiles) {
  const OptimizeRig rig;
  const OptimizationResult result = expect_same_files(
      rig,
      kHead + kSearch + kPart +
          "[compare]\nreplicates = 3\noverlays = [\"sticky.toml\", \"loose.toml\"]\n",
      {"search.state", "evaluations.csv", "history.csv", "optimum.toml", "compare.toml"});
  // The comparison is a study that can be read.
  const Study study(result.compare);
  EXPECT_EQ(study.plan().settings.size(), 3u);
  EXPECT_TRUE(study.plan().until_settled);
}

TEST(Optimize, ASeedReplacesThatOfTheFile) {
  const OptimizeRig rig;
  const Optimization what = rig.read(
      kHead + kPart + "[compare]\nreplicates = 3\noverlays = [\"sticky.toml\"]\n", {"run.seed=77"});
  EXPECT_EQ(what.plan().seed, 77u);
  EXPECT_EQ(what.source().file.compare.seed, 78u);
}

// A study has no scenario twice: an overlay that says what the optimum says is left out.
TEST(Optimize, TheOptimumIsNotComparedWithItself) {
  const OptimizeRig rig;
  rig.here.write("half.toml", "[rules]\npart.p = 0.5\n");
  const Optimization what =
      rig.read(kHead + kPart +
               "[compare]\nreplicates = 3\noverlays = [\"sticky.toml\", \"half.toml\"]\n"
               "labels = [\"sticky\", \"as it is\"]\n");
  for (const double p : {0.5, 0.25}) {
    const std::string optimum =
        rig.here.write("out/optimum.toml", what.overlay({p}, "optimum", "").front().content);
    const OptimumComparison made = comparison_with(what.source(), optimum);
    const bool same = p == 0.5;
    EXPECT_EQ(made.left_out, std::vector<std::string>(same ? 1 : 0, "as it is"));
    EXPECT_EQ(made.text.find("# Left out") != std::string::npos, same) << made.text;
    const Study study(rig.here.write("out/compare.toml", made.text));
    EXPECT_EQ(study.plan().settings.size(), same ? 2u : 3u);
  }
}

// What the comparison would refuse after the search is refused before.
TEST(Optimize, OverlaysToCompareWithAreCheckedFirst) {
  const OptimizeRig rig;
  rig.here.write("wrong.toml", "[rules]\nprat.p = 0\n");
  rig.here.write("crowd.toml", "[module]\ncount = 500\n");
  rig.here.write("glued.toml", "[rules]\npart.p = 0\n");
  const auto refused = [&](const std::string& overlays, const std::vector<std::string>& sets = {}) {
    return rig.refused(kHead + kPart + "[compare]\nreplicates = 3\noverlays = [" + overlays + "]\n",
                       sets);
  };
  const auto expect = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect(refused("\"wrong.toml\""), "wrong.toml:2:1: unknown key 'rules.prat.p'");
  expect(refused("\"crowd.toml\""), "crowd: ");
  expect(refused("\"sticky.toml\", \"glued.toml\""),
         "optimize.toml:9:12: overlays 'sticky' and 'glued' make one and the same scenario");
  expect(refused("\"sticky.toml\"", {"run.seed=x"}), "run.seed is a whole number, not text");
  EXPECT_EQ(refused("\"sticky.toml\""), "(accepted)");
}

TEST(Optimize, WhatMakesNoSenseIsRefused) {
  const OptimizeRig rig;
  const auto expect = [&](const std::string& text, const std::string& message) {
    EXPECT_NE(rig.refused(text).find(message), std::string::npos) << rig.refused(text);
  };
  expect(kHead, "optimize.toml:1:1: nothing is to be searched");
  expect(kHead + "fitnes = \"eq10\"\n" + kPart, "optimize.toml:3:1: unknown key 'optimize.fitnes'");
  expect(kHead + "fitness = \"eq11\"\n" + kPart, "did you mean 'eq10'?");
  expect(kHead + "rate_weight = 3\n" + kPart, "goes with fitness = \"rate_and_yield\" only");
  expect(kHead + "method = \"cma-es\"\n" + kPart, "did you mean 'cma_es'?");
  expect(kHead + "particles = 3\n" + kPart, "optimize.toml:3:13: optimize.particles goes with");
  expect(kHead + "[[parameter]]\npath = \"rules.pat.p\"\nlow = 0\nhigh = 1\n",
         "did you mean 'part'?");
  expect(kHead + "[[parameter]]\npath = \"rules.x*.p\"\nlow = 0\nhigh = 1\n", "fits no rule");
  expect(kHead + "[[parameter]]\npath = \"rules.part.p\"\nlow = 0\nhigh = 2\n", "outside 0 .. 1");
  expect(kHead + "[[parameter]]\npath = \"rules.part.p\"\nlow = 0\nhigh = 1\nscale = \"log\"\n",
         "needs a parameter.low above 0");
  expect(kHead + "[[parameter]]\npath = \"rules.part.p\"\nlow = 1\nhigh = 0.5\n",
         "parameter.high is not above");
  expect(kHead + "hybrid = true\n[[parameter]]\npath = \"module.count\"\nlow = 4\nhigh = 6\n",
         "no [[parameter]] is one");
  expect(kHead + kPart + "[agitation]\nkind = \"feedback\"\nlow = 40\nhigh = 120\n",
         "not in order within 0 .. 100 %");
  expect(kHead + kPart + "[compare]\nreplicates = 3\noverlays = [\"stiky.toml\"]\n",
         "optimize.toml:9:13: cannot read");
  expect(
      kHead + "evaluations = 3\nfinal_evaluations = 4\n" + kPart,
      "optimize.toml:4:21: optimize.final_evaluations = 4 is more than optimize.evaluations = 3");
  expect(kHead + "hybrid = false\nevaluations = 3\n" + kPart,
         "optimize.toml:4:15: a budget of 3 evaluations does not hold one generation");
  EXPECT_NE(rig.refused(kHead + kPart, {"rules.part.p=0.1"}).find("'rules.part.p' is searched"),
            std::string::npos);
  EXPECT_NE(rig.refused(kHead + kPart, {"module.count=1"}).find("1 modules make no copy of 2"),
            std::string::npos);
}

}  // namespace
}  // namespace lilytank::test
