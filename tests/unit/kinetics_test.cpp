#include "lilytank/kinetics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "lilytank/run.hpp"
#include "lilytank/synthesis.hpp"
#include "support/control_rig.hpp"
#include "support/study_rig.hpp"

using namespace lilytank;
using lilytank::test::rules_of;
using lilytank::test::ruleset_file;

namespace {

Ruleset pair_rules(double p) {
  Ruleset rules = rules_of(
      "target\n  ##\nend\nr1: (0,0) (0,0) -> (1,1)-(2,1)\nr1_reverse: (1,1)-(2,1) -> (0,0) "
      "(0,0)\n");
  rules.rules[1].p = p;
  return rules;
}

// Two modules that bind at rate k and part at rate q are bound at time t with probability
// k / (k + q) (1 - exp(-(k + q) t)).
TEST(Gillespie, DimerOfTwoModulesFollowsTheClosedForm) {
  const double face_rate = 0.01, evaluation_rate = 0.5, p = 0.2;
  const double k = 16 * face_rate, q = evaluation_rate * p;
  const Kinetics kinetics = kinetics_of(pair_rules(p), face_rate, evaluation_rate, 2);
  constexpr int kRuns = 10000;
  for (const double t : {1.0, 4.0, 30.0}) {
    int bound = 0;
    for (int run = 0; run < kRuns; ++run) {
      GillespieOptions options;
      options.modules = 2, options.duration = t, options.seed = static_cast<std::uint64_t>(run + 1);
      bound += run_gillespie(kinetics, options).counts[1];
    }
    const double expected = k / (k + q) * (1 - std::exp(-(k + q) * t));
    const double sigma = std::sqrt(expected * (1 - expected) / kRuns);
    EXPECT_NEAR(bound / static_cast<double>(kRuns), expected, 5 * sigma) << t;
  }
}

// In equilibrium d dimers of M modules have probability ~ (k/q)^d M! / ((M - 2d)! d! 2^d).
TEST(Gillespie, DimersOfTenModulesComeToEquilibrium) {
  const double k = 0.16, q = 0.4;
  const Kinetics kinetics = kinetics_of(pair_rules(1), k / 16, q, 10);
  std::vector<double> expected(6);
  double sum = 0;
  for (int d = 0; d <= 5; ++d) {
    expected[static_cast<std::size_t>(d)] =
        std::exp(d * std::log(k / q / 2) - std::lgamma(11 - 2 * d) - std::lgamma(d + 1));
    sum += expected[static_cast<std::size_t>(d)];
  }
  constexpr int kRuns = 4000;
  std::vector<int> seen(6, 0);
  for (int run = 0; run < kRuns; ++run) {
    GillespieOptions options;
    options.modules = 10, options.duration = 60, options.seed = static_cast<std::uint64_t>(run + 1);
    ++seen[static_cast<std::size_t>(run_gillespie(kinetics, options).counts[1])];
  }
  for (std::size_t d = 0; d <= 5; ++d) {
    const double share = expected[d] / sum;
    EXPECT_NEAR(seen[d] / static_cast<double>(kRuns), share,
                5 * std::sqrt(share * (1 - share) / kRuns))
        << d;
  }
}

TEST(Gillespie, CopiesAreTimedAndTheSeedDecides) {
  const Ruleset rules = read_ruleset(ruleset_file("chain5"));
  const Kinetics kinetics = kinetics_of(rules, 1e-4, 0.68, 15);
  GillespieOptions options;
  options.duration = 1e6;
  const GillespieResult a = run_gillespie(kinetics, options);
  EXPECT_EQ(a.copies, 3);
  ASSERT_EQ(a.completion.size(), 3u);
  EXPECT_TRUE(std::is_sorted(a.completion.begin(), a.completion.end()));
  EXPECT_EQ(run_gillespie(kinetics, options).completion, a.completion);
  options.seed = 2;
  EXPECT_NE(run_gillespie(kinetics, options).completion, a.completion);
}

TEST(Gillespie, CompetingSeedsShareTheDockings) {
  const Target target = parse_target("######", "chain6.txt");
  const Ruleset rules = emit(target, make_plan(target, Algorithm::linchpin));
  const Kinetics kinetics = kinetics_of(rules, 1e-3, 0.68, 12);
  int seeds = 0;
  for (std::size_t k = 0; k < kinetics.rate.size(); ++k) {
    const Reaction& reaction = kinetics.network.reactions[k];
    if (reaction.from != std::vector<int>{0, 0}) continue;
    ++seeds;
    EXPECT_DOUBLE_EQ(kinetics.rate[k], 16e-3 / 2);
  }
  EXPECT_EQ(seeds, 2);
}

Event event(EventKind kind, int a, int face_a, int b, int face_b, int rule = -1, int label_a = 0,
            int last_a = -1, int label_b = 0, int last_b = -1) {
  Event e;
  e.kind = kind, e.a = a, e.b = b, e.rule = static_cast<std::int16_t>(rule);
  e.face_a = static_cast<std::int8_t>(face_a), e.face_b = static_cast<std::int8_t>(face_b);
  e.label_a = label_a, e.label_b = label_b;
  e.last_a = static_cast<std::int8_t>(last_a), e.last_b = static_cast<std::int8_t>(last_b);
  return e;
}

TEST(RateRecord, CountsByHand) {
  const Ruleset rules = read_ruleset(ruleset_file("chain5"));
  RateRecord record(rules, 4);
  record.observe(event(EventKind::latch, 0, 1, 1, 3), 10);
  record.observe(event(EventKind::link, 0, 1, 1, 3, 0, 1, 1, 2, 3), 12);
  record.observe(event(EventKind::latch, 2, 0, 3, 0), 14);
  record.observe(event(EventKind::unlatch, 2, 0, 3, 0), 15);
  record.observe(event(EventKind::unlink, 0, 1, 1, 3, 4), 20);
  const RateTable table = record.table(30);
  EXPECT_EQ(table.seconds, 30);
  EXPECT_EQ(table.contacts, 2);
  EXPECT_DOUBLE_EQ(table.contact_seconds, 3);
  EXPECT_DOUBLE_EQ(table.bond_seconds, 8);
  ASSERT_EQ(table.standing.size(), 2u);
  const std::string single = "0,0,0,-1,0";
  EXPECT_DOUBLE_EQ(table.standing.at(single).exposure, 4 * 12 + 2 * 8 + 4 * 10);
  const auto& singles = table.meetings.at({single, single});
  EXPECT_EQ(singles.dockings, 2);
  EXPECT_EQ(singles.links.at("r1"), 1);
  EXPECT_DOUBLE_EQ(singles.exposure, 6 * 12 + 1 * 8 + 6 * 10);
  int changes = 0;
  for (const auto& [key, standing] : table.standing)
    for (const auto& [rule, n] : standing.changes)
      changes += rule == "r1_reverse" ? static_cast<int>(n) : 99;
  EXPECT_EQ(changes, 1);
}

TEST(RateTable, ReadsBackAndAddsUp) {
  const Ruleset rules = read_ruleset(ruleset_file("chain5"));
  RateRecord record(rules, 4);
  record.observe(event(EventKind::latch, 0, 1, 1, 3), 10);
  record.observe(event(EventKind::link, 0, 1, 1, 3, 0, 1, 1, 2, 3), 12.025);
  RateTable table = record.table(30);
  const std::string text = to_csv(table);
  EXPECT_EQ(to_csv(rate_table_from(text, "rates.csv")), text);
  table.add(rate_table_from(text, "rates.csv"));
  EXPECT_EQ(table.worlds, 2);
  EXPECT_EQ(table.seconds, 60);
  EXPECT_EQ(table.contacts, 2);
  EXPECT_THROW(rate_table_from("kind,rule\n", "x"), InputError);
  EXPECT_THROW(rate_table_from("kind,rule,a,b,events,exposure_s\nodd,,,,1,1\n", "x"), InputError);
  EXPECT_THROW(rate_table_from("kind,rule,a,b,events,exposure_s\n", "x"), InputError);
}

// Planted rates are found again: worlds of the well-mixed model itself, followed as events would
// be.
TEST(Kinetics, RecoversPlantedRates) {
  const Ruleset rules = pair_rules(0.5);
  RateTable table;
  table.worlds = 1;
  const std::string single = "0,0,0,-1,0";
  const Kinetics planted = kinetics_of(rules, 2e-4, 0.68, 10);
  const std::string dimer = planted.network.species[1].key;
  table.meetings[{single, single}].links["r1"] = 3200;
  table.meetings[{single, single}].exposure = 1e6;
  table.standing[dimer].exposure = 1e4;
  table.standing[dimer].changes["r1_reverse"] = 3400;
  table.evaluations = 6800, table.bond_seconds = 1e4;
  const Kinetics found = kinetics_of(rules, table, 10);
  EXPECT_DOUBLE_EQ(found.face_rate, 2e-4);
  EXPECT_DOUBLE_EQ(found.evaluation_rate, 0.68);
  ASSERT_EQ(found.rate.size(), 2u);
  EXPECT_NEAR(found.rate[0], planted.rate[0], 1e-9);
  EXPECT_NEAR(found.rate[1], planted.rate[1], 1e-12);
  EXPECT_THROW(kinetics_of(read_ruleset(ruleset_file("o4")), RateTable{}, 10), InputError);
}

// What a run stored tells the same as its world while it is followed, whatever p the rules have
// that are then asked about.
TEST(Kinetics, RatesOfAStoredRunAreThoseOfItsWorld) {
  const test::StudyRig rig;
  const Scenario scenario =
      load_scenario({rig.here.path("pair.toml")}, {"run.duration='10 min'", "rules.part.p=0.05"});
  RunOptions options;
  options.out = rig.here.path("run");
  ASSERT_EQ(run(scenario, options).status, RunStatus::ok);
  const RateTable stored = rates_of_run(options.out);
  const RateTable followed = measure_world(scenario.model, scenario.seed, scenario.duration).rates;
  EXPECT_GT(stored.evaluations, 100);
  EXPECT_EQ(stored.evaluations, followed.evaluations);
  EXPECT_EQ(stored.contacts, followed.contacts);
  EXPECT_NEAR(stored.bond_seconds, followed.bond_seconds, 1e-6);
  EXPECT_NEAR(stored.seconds, followed.seconds, 1e-6);
  const Ruleset others = read_ruleset(rig.here.path("pair.rules"));
  ASSERT_EQ(others.rules[1].p, 0.5);
  EXPECT_NEAR(kinetics_of(others, stored, 6).evaluation_rate, 0.68, 0.1);
}

TEST(Kinetics, ARunCountsForTheTimeThatItSimulated) {
  const test::StudyRig rig;
  const Scenario whole = load_scenario({rig.here.path("pair.toml")}, {});
  std::atomic<bool> stop = true;
  RunOptions options;
  options.out = rig.here.path("run");
  options.stop = &stop;
  ASSERT_THROW(run(whole, options), Stopped);
  try {
    rates_of_run(options.out);
    ADD_FAILURE() << "the run is not over";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("is not over"), std::string::npos) << error.what();
  }
  stop = false;
  ASSERT_EQ(run(whole, options).status, RunStatus::ok);
  EXPECT_DOUBLE_EQ(rates_of_run(options.out).seconds, whole.duration);
  const Scenario torn = load_scenario({rig.here.path("pair.toml")},
                                      {"module.mass='0.1 g'", "forces.body_force.force_x=1"});
  options.out = rig.here.path("torn");
  ASSERT_EQ(run(torn, options).status, RunStatus::diverged);
  const RateTable short_one = rates_of_run(options.out);
  EXPECT_LT(short_one.seconds, 0.1);
  EXPECT_LT(short_one.standing.at("0,0,0,-1,0").exposure, 0.6);
}

}  // namespace
