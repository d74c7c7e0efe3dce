// Recordings with latches on: assemblies from poses, their prediction as one body, and how modules
// latch and part.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "effects/bond_effects.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/predictor.hpp"
#include "proof/sealed.hpp"
#include "scores/bond_numbers.hpp"
#include "scores/scores.hpp"
#include "support/filmed.hpp"
#include "tracks/seen_bonds.hpp"

namespace lilytank {
namespace {

constexpr double kLilySide = 0.03;

// Modules that latch and, without rules, never part.
Model latching(int modules) {
  Model model = test::drifting(modules);
  model.control.latches = true;
  return model;
}

std::vector<Recording> latched_film(const Model& model, double seconds, std::uint64_t seed,
                                    double settle = 20) {
  RecordingShape shape;
  shape.name = "simulated", shape.bodies = model.module.count, shape.latches = true;
  shape.frames = static_cast<int>(30 * seconds) + 1;
  EmulatorOptions options;
  options.settle = settle;
  return *Emulator(model, {}, {shape}, options).record({}, seed);
}

// Two modules face to face in frames 30 to 89 of 120, one turned by a quarter, 10 mm apart else.
Recording two_meeting() {
  Recording r;
  r.frames = 120;
  for (int m = 0; m < 2; ++m) {
    Track& t = r.tracks.emplace_back();
    t.id = 7 + m;
    for (int f = 0; f < r.frames; ++f) {
      const double gap = f >= 30 && f < 90 ? 0 : 0.01;
      t.x.push_back(m * (kLilySide + gap)), t.y.push_back(0.001 * f);
      t.theta.push_back(0.02 + m * kPi / 2);
    }
  }
  return r;
}

TEST(SeenBonds, BeginAndEndWhereModulesMeetAndPart) {
  const std::vector<SeenBond> bonds = seen_bonds(two_meeting(), kLilySide);
  ASSERT_EQ(bonds.size(), 1u);
  EXPECT_EQ(bonds[0].a, 7);
  EXPECT_EQ(bonds[0].b, 8);
  EXPECT_EQ(bonds[0].begin, 30);
  EXPECT_EQ(bonds[0].known, 39);
  EXPECT_EQ(bonds[0].end, 90);
  EXPECT_TRUE(bonds[0].parted);
  EXPECT_NEAR(bonds[0].before, 0.01, 1e-3);
}

TEST(SeenBonds, AreLessThanMeetings) {
  Recording r = two_meeting();
  EXPECT_EQ(meetings(r, kLilySide, 0.005, 0.2), 1);
  for (double& theta : r.tracks[1].theta) theta += 0.1;
  EXPECT_EQ(meetings(r, kLilySide, 0.005, 0.2), 1);
  EXPECT_EQ(meetings(r, kLilySide, 0.005, 0.05), 0);
  for (int f = 40; f < 50; ++f) r.tracks[1].x[static_cast<std::size_t>(f)] += 0.006;
  EXPECT_EQ(meetings(r, kLilySide, 0.005, 0.2), 1) << "not half a reach out of reach";
  for (int f = 40; f < 50; ++f) r.tracks[1].x[static_cast<std::size_t>(f)] += 0.003;
  EXPECT_EQ(meetings(r, kLilySide, 0.005, 0.2), 2);
}

TEST(SeenBonds, OutlastShortGapsButNotLongOnes) {
  Recording r = two_meeting();
  for (int f = 50; f < 60; ++f) r.tracks[0].x[static_cast<std::size_t>(f)] = std::nan("");
  EXPECT_EQ(seen_bonds(r, kLilySide).at(0).end, 90);
  for (int f = 50; f < 80; ++f) r.tracks[0].x[static_cast<std::size_t>(f)] = std::nan("");
  const SeenBond first = seen_bonds(r, kLilySide).at(0);
  EXPECT_EQ(first.end, 50);
  EXPECT_FALSE(first.parted);
}

TEST(SeenBonds, AreNoneWhereModulesOnlyPassByOrStandAskew) {
  Recording r = two_meeting();
  for (double& theta : r.tracks[1].theta) theta += 0.4;
  EXPECT_TRUE(seen_bonds(r, kLilySide).empty());
  r = two_meeting();
  for (int f = 35; f < 90; ++f) r.tracks[1].x[static_cast<std::size_t>(f)] += 0.01;
  EXPECT_TRUE(seen_bonds(r, kLilySide).empty());
}

// A chain of three, which nothing else touches: its innovations have no mean and the variance that
// the filter predicts for a rigid body of its mass.
TEST(Predictor, PredictsAssembliesAsOneBody) {
  Model model = latching(3);
  model.start.layout = Layout::poses;
  for (int m = -1; m <= 1; ++m)
    model.start.poses.push_back({m * (model.module.side + 1e-3), 0.1, Rot{}});
  const std::vector<Recording> alone = test::filmed(test::drifting(6), 30, 3);
  const std::vector<Recording> recordings = latched_film(model, 120, 4, 0);
  double place = 0, turn = 0, drift = 0, count = 0;
  predict(model, recordings, predictor_options(model, alone), [&](const PredictedFrame& f) {
    for (const PredictedAssembly& a : f.assemblies) {
      const Innovation& e = a.innovation;
      for (const int i : a.members) EXPECT_EQ(f.usable[static_cast<std::size_t>(i)], 0);
      if (a.members.size() < 3 || !a.usable || std::isnan(e.dx) || a.contact > 0.03) continue;
      place += 0.5 * (e.dx * e.dx + e.dy * e.dy) / (e.sd_x * e.sd_x);
      turn += e.dtheta * e.dtheta / (e.sd_theta * e.sd_theta), drift += e.dx / e.sd_x, count += 1;
    }
  });
  ASSERT_GT(count, 2000);
  EXPECT_NEAR(drift / count, 0, 5 / std::sqrt(count));
  EXPECT_NEAR(place / count, 1, 0.1);
  EXPECT_NEAR(turn / count, 1, 0.1);
}

// Latches off: nothing is an assembly, whoever touches.
TEST(Predictor, KnowsNoAssembliesWhereLatchesAreOff) {
  const Model model = test::drifting(8);
  std::vector<Recording> recordings = test::filmed(model, 20, 4);
  predict(model, recordings, predictor_options(model, recordings),
          [&](const PredictedFrame& f) { EXPECT_TRUE(f.assemblies.empty()); });
}

// The members' pushes together: a constant force on every module, seen on assemblies.
TEST(Scores, SeeAPlantedPushOnAssemblies) {
  const Model model = latching(8);
  const auto without = latched_film(model, 90, 5);
  const auto with =
      latched_film(with_parameters(model, std::vector<std::string>{"forces.body_force.force_x"},
                                   std::vector<double>{4e-3}),
                   90, 5);
  ScorePlan plan = test::plan_for(model, without);
  const std::vector<ScoreEntry> entries = plan.entries();
  const auto named = std::find_if(entries.begin(), entries.end(), [](const ScoreEntry& e) {
    return e.name == "body_force force_x";
  });
  const auto at = static_cast<std::size_t>(named - entries.begin());
  const double nothing = score(plan, without)[at], pushed = score(plan, with)[at];
  EXPECT_LT(std::fabs(nothing), 1.0);
  EXPECT_NEAR(pushed - nothing, 4.0 / 1.5, 1.2);
}

double bond_number(const std::string& name, const std::vector<Recording>& recordings) {
  ScorePlan plan;
  plan.model = latching(2), plan.model.module.side = kLilySide,
  plan.logged = recordings.front().logged;
  const std::vector<ScoreEntry> entries = bond_entries(plan);
  const std::vector<double> numbers = bond_numbers(plan, recordings);
  EXPECT_EQ(entries.size(), numbers.size());
  const auto at = std::ranges::find(entries, name, &ScoreEntry::name);
  if (at != entries.end()) return numbers[static_cast<std::size_t>(at - entries.begin())];
  ADD_FAILURE() << name;
  return 0;
}

// A lens that makes what is far from its axis longer changes the length of bonds there.
TEST(BondNumbers, ShowALens) {
  std::vector<Recording> recordings;
  for (const double far : {0.0, 0.05, 0.1}) {
    Recording& r = recordings.emplace_back(two_meeting());
    for (Track& t : r.tracks) {
      for (double& x : t.x) x += far;
      std::ranges::fill(t.y, 0);
    }
  }
  const char* across = "length of bonds across the image";
  EXPECT_NEAR(bond_number("length of bonds", recordings), 0, 1e-9);
  EXPECT_NEAR(bond_number(across, recordings), 0, 1e-9);
  EXPECT_NEAR(bond_number("bonds per meeting", recordings), 3.5 / 4, 1e-9);
  for (Recording& r : recordings) {
    for (Track& t : r.tracks) {
      for (double& x : t.x) x *= 1 + x * x;
    }
  }
  EXPECT_GT(bond_number("length of bonds", recordings), 1e-4);
  EXPECT_GT(bond_number(across, recordings), 1e-3);
}

// Counted by hand from a log of 100 s of two modules.
TEST(BondNumbers, CountALog) {
  Recording r = two_meeting();
  r.frames = 3000;
  for (Track& t : r.tracks) t.x.resize(3000, 0), t.y.resize(3000, 0), t.theta.resize(3000, 0);
  r.logged = true;
  r.events = {{1, EventKind::latch, 0, 1},
              {3, EventKind::unlatch, 1, 0},
              {10, EventKind::latch, 0, 1},
              {14, EventKind::link, 0, 1},
              {54, EventKind::unlink, 0, 1}};
  const auto number = [&](const std::string& name) { return bond_number(name, {r}); };
  EXPECT_DOUBLE_EQ(number("logged latches"), std::log(2.5 / 201));
  EXPECT_DOUBLE_EQ(number("decisions on a latch"), std::log(2.5 / (2 + 4 + 1)));
  EXPECT_DOUBLE_EQ(number("time to unlatch"), std::log(1.5 / 3));
  EXPECT_DOUBLE_EQ(number("time to link"), std::log(1.5 / 5));
  EXPECT_DOUBLE_EQ(number("unlinked bonds"), std::log(1.5 / 41));
  EXPECT_DOUBLE_EQ(number("updates of labels"), std::log(0.5 / 41));
}

TEST(BondEffects, AreThoseOfTheModelsControl) {
  Model model = test::drifting(2);
  EXPECT_TRUE(bond_effects(model).empty());
  model.control.latches = true;
  for (const Effect& e : bond_effects(model)) EXPECT_NE(e.name, "evaluation_rate");
  model.rulesets.emplace_back();
  model.control.clock = Clock::events;
  const std::vector<Effect> all = bond_effects(model);
  const auto rate = std::find_if(all.begin(), all.end(),
                                 [](const Effect& e) { return e.name == "evaluation_rate"; });
  ASSERT_NE(rate, all.end());
  EXPECT_EQ(rate->absent(model, 0), model.control.evaluation_rate);
  EXPECT_EQ(with_effect(model, *rate, {0.2}).control.evaluation_rate, 0.2);
}

TEST(BondEffects, KeepProbabilitiesWithinTheirBounds) {
  Model model = test::drifting(2);
  model.control.latches = true, model.rulesets.emplace_back();
  for (const Effect& e : bond_effects(model)) {
    if (e.logarithmic(0)) continue;
    const Eigen::VectorXd far = Eigen::VectorXd::Constant(1, 1e9);
    const ParameterInfo bounds = model_parameter(e.paths[0]);
    EXPECT_LT(e.value(model, 0, e.within(far)(0)), bounds.high) << e.name;
    EXPECT_GE(e.value(model, 0, e.within(-far)(0)), bounds.low) << e.name;
  }
}

// Firmware that begins exchanges more often than the model's does not evaluate bonds more often.
TEST(BondEffects, LowerTheInitiativeOfFirmwareByFactors) {
  Model model = test::drifting(2);
  model.control.latches = true, model.rulesets.emplace_back();
  const Effect e = bond_effects(model).front();
  ASSERT_EQ(e.paths[0], "control.initiative");
  EXPECT_FALSE(e.two_sided);
  const double initiative = model.control.initiative;
  EXPECT_NEAR(e.value(model, 0, 1), initiative / 3, 0.002 * initiative);
  EXPECT_NEAR(e.value(model, 0, 2), initiative / 9, 0.002 * initiative);
  EXPECT_NEAR(e.amplitude(model, 0, e.value(model, 0, 1.3)), 1.3, 1e-12);
  const Effect loss = bond_effects(model)[1];
  const Effect both = together({loss, e});
  EXPECT_EQ(both.value(model, 0, 0.8), loss.value(model, 0, 0.8));
  EXPECT_EQ(both.value(model, 1, 0.8), e.value(model, 0, 0.8));
}

// Two effects at once need two that can be there at once: faults of the control can, one alone
// cannot.
TEST(Sealed, AreTwoEffectsOnlyWhereThereAreTwo) {
  Model tank = latching(2);
  const std::vector<Effect> all = bond_effects(tank);
  ASSERT_EQ(all.size(), 2u);
  const std::vector<Shape> laws = shape_catalogue(tank, 60);
  EXPECT_EQ(seal(tank, all, laws, 1, 3).names.size(), 2u);
  EXPECT_EQ(seal(tank, {all.front()}, laws, 1, 3).kind, "named");
}

}  // namespace
}  // namespace lilytank
