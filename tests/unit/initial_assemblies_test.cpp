// Recordings that begin with assemblies: simulations of them begin with the same ones.
#include "emulator/initial_assemblies.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "lilytank/assembly_record.hpp"
#include "lilytank/start.hpp"
#include "lilytank/trajectory.hpp"
#include "support/control_rig.hpp"
#include "support/filmed.hpp"
#include "tracks/seen_bonds.hpp"

namespace lilytank {
namespace {

Ruleset chain5() {
  return read_ruleset(test::ruleset_file("chain5"));
}

std::vector<int> labels_of(const Pattern& pattern) {
  std::vector<int> out;
  for (const PatternModule& m : pattern) out.push_back(m.label);
  return out;
}

// A chain of three has grown from either end.
TEST(Labellings, AreAllThatTheRulesCanMakeInTheseCells) {
  const Labellings known(chain5(), 15);
  const std::vector<Cell> row{{4, 1}, {5, 1}, {6, 1}};
  const std::vector<Pattern> chains = known.of(row);
  ASSERT_EQ(chains.size(), 2u);
  EXPECT_EQ(labels_of(chains[0]), (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(labels_of(chains[1]), (std::vector<int>{4, 3, 2}));
  for (const Pattern& chain : chains) {
    for (std::size_t k = 0; k < row.size(); ++k) EXPECT_EQ(chain[k].cell, row[k]);
    EXPECT_EQ(chain[1].bonds, 5u);  // towards +x and -x
  }
  EXPECT_EQ(known.of({{0, 2}, {0, 1}, {0, 0}}).size(), 2u);
  EXPECT_TRUE(known.of({{0, 0}, {1, 0}, {1, 1}}).empty());
  EXPECT_TRUE(Labellings(chain5(), 2).of(row).empty());
}

// As dimers of crosses are: equal after half a turn.
TEST(Labellings, OfASymmetricAssemblyAreCountedOnce) {
  Ruleset rules;
  rules.rules = {{"join", RuleKind::link, {Label{0, 0}, {0, 0}}, {Label{1, 1}, {1, 1}}}};
  EXPECT_EQ(Labellings(rules, 15).of({{0, 0}, {0, 1}}).size(), 1u);
}

// Module `turned` quarters, in a row from the origin; a millimetre of noise.
Pose in_row(int place, int quarters, double side) {
  return {place * side + 0.001 * (place % 2), 0.0005 * place, rotation(0.02 + quarters * kPi / 2)};
}

TEST(StartBonds, MakeOneBodyThatKeepsItsMomentum) {
  Model model = test::quiet_model(3, {chain5()});
  const double side = model.module.side;
  State state = state_of_poses(model, {in_row(0, 0, side), in_row(1, 1, side), {0.2, 0.2, {}}}, 1);
  state.vx[0] = 0.1, state.vy[1] = -0.04;
  const Face free = state.faces[8];
  EXPECT_TRUE(make_bonds(model, {{0, 0, 1, 1}}, state));
  EXPECT_EQ(state.assembly, (std::vector<std::int32_t>{0, 0, 2}));
  EXPECT_NEAR(state.vx[0], 0.05, 1e-12);
  EXPECT_NEAR(state.vy[0], -0.02, 1e-12);
  EXPECT_EQ(state.faces[0].status, FaceStatus::bonded);
  EXPECT_EQ(state.faces[4 + 1].partner, 0);
  EXPECT_EQ(state.faces[8].status, free.status);
  EXPECT_LT(deepest_overlap(model, state).depth, kStartTolerance);
  // Module 2 cannot lie where module 1 is.
  EXPECT_FALSE(make_bonds(model, {{0, 0, 2, 2}}, state));
  EXPECT_EQ(state.faces[8 + 2].partner, -1);
}

std::vector<int> sizes(const Model& model, const State& state) {
  AssemblyRecord record(model);
  record.observe(World(model, state));
  EXPECT_EQ(record.illegal(), 0);
  return record.by_size();
}

// Modules that only touch are seen bonded for the shortest time: the fourth one, beside a chain.
TEST(InitialAssemblies, LeaveOutTheShortestContactsThatTheRulesDoNotAllow) {
  Model model = test::quiet_model(4, {chain5()});
  const double side = model.module.side;
  BodiesAt start;
  start.pose = {in_row(0, 3, side), in_row(1, 0, side), in_row(2, 1, side), {}};
  start.pose[3] = {0.001, side, rotation(0)};
  start.twist.resize(4);
  start.bonds = {{0, 3, 2}, {0, 1, 60}, {1, 2, 40}};
  State state = state_of_poses(model, start.pose, 1);
  InitialAssemblies(model).bond(model, start, 1, state);
  EXPECT_EQ(sizes(model, state), (std::vector<int>{0, 1, 0, 1, 0}));
  EXPECT_EQ(state.firmware[3].label, 0);
  EXPECT_EQ(state.firmware[1].label, 3);
}

Model chains(int modules) {
  Model model = test::drifting(modules);
  model.control.latches = true, model.rulesets = {chain5()};
  return model;
}

// What a perfect camera sees of a world.
BodiesAt seen_in(const World& world) {
  BodiesAt out;
  Trajectory poses;
  append_poses(world, poses);
  const State& state = world.state();
  for (int i = 0; i < world.model().module.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out.pose.push_back({poses.x[k], poses.y[k], rotation(poses.theta[k])});
    for (int f = 0; f < 4; ++f) {
      const Face& face = state.faces[4 * k + static_cast<std::size_t>(f)];
      if (face.status == FaceStatus::bonded && face.partner > i) {
        out.bonds.push_back({i, face.partner, 60});
      }
    }
  }
  return out;
}

std::vector<int> labels_of(const State& state) {
  std::vector<int> out;
  for (const Firmware& f : state.firmware) out.push_back(4 * f.label + f.last);
  return out;
}

// A chain of two and a module that the rules would add, but that soon parts.
TEST(InitialAssemblies, LeaveOutLatchesThatNoRuleMadeABond) {
  const Model model = test::quiet_model(3, {chain5()});
  const double side = model.module.side;
  BodiesAt start;
  start.pose = {in_row(0, 3, side), in_row(1, 0, side), in_row(2, 1, side)};
  start.twist.resize(3);
  start.bonds = {{0, 1, 60, true}, {1, 2, 3, true}};
  const InitialAssemblies assemblies(model);
  State state = state_of_poses(model, start.pose, 1);
  assemblies.bond(model, start, 1, state);
  EXPECT_EQ(sizes(model, state), (std::vector<int>{0, 1, 1, 0}));
  // The end of the recording is no parting.
  start.bonds[1].parts = false;
  state = state_of_poses(model, start.pose, 1);
  assemblies.bond(model, start, 1, state);
  EXPECT_EQ(sizes(model, state), (std::vector<int>{0, 0, 0, 1}));
}

// Chains after four minutes: the same assemblies, and of every module the true label is drawn.
TEST(InitialAssemblies, AreThoseOfTheWorldThatWasSeen) {
  const Model model = chains(15);
  World world(model, 3);
  while (world.time() < 240) ASSERT_EQ(world.step(), RunStatus::ok);
  const BodiesAt seen = seen_in(world);
  ASSERT_GT(seen.bonds.size(), 5u);
  const std::vector<int> truth = labels_of(world.state());
  const InitialAssemblies assemblies(model);
  std::vector<int> right(truth.size(), 0);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    State state = state_of_poses(model, seen.pose, seed);
    assemblies.bond(model, seen, seed, state);
    EXPECT_EQ(sizes(model, state), sizes(model, world.state()));
    const std::vector<int> drawn = labels_of(state);
    for (std::size_t i = 0; i < truth.size(); ++i) right[i] += drawn[i] == truth[i] ? 1 : 0;
  }
  // Of two labellings each is drawn 10 times of 20, of the single one always.
  for (const int times : right) EXPECT_GE(times, 3);
}

int bonds_at(const Recording& recording, double side, int frame) {
  const std::vector<SeenBond> bonds = seen_bonds(recording, side);
  return static_cast<int>(std::count_if(bonds.begin(), bonds.end(), [&](const SeenBond& b) {
    return b.begin <= frame && b.end > frame;
  }));
}

// From its fourth minute on, as a lab cuts a film of a long experiment.
TEST(InitialAssemblies, StandInSimulationsOfARecordingThatBeginsWithThem) {
  const Model model = chains(15);
  RecordingShape whole;
  whole.name = "whole", whole.bodies = 15, whole.latches = true, whole.frames = 30 * 250;
  Recording cut = Emulator(model, {}, {whole}).record({}, 5)->front();
  constexpr int kFirst = 30 * 240;
  for (Track& t : cut.tracks) {
    ASSERT_EQ(t.first, 0);
    for (auto* of : {&t.x, &t.y, &t.theta}) of->erase(of->begin(), of->begin() + kFirst);
  }
  cut.frames -= kFirst;
  const double side = model.module.side;
  const RecordingShape shape = shape_of(cut, side);
  const Emulator emulator(model, {}, {shape});
  const int recorded = bonds_at(cut, side, 150);
  ASSERT_GT(recorded, 5);
  double simulated = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    simulated += bonds_at(emulator.record({}, seed)->front(), side, 150) / 10.0;
  }
  EXPECT_NEAR(simulated, recorded, 2);
}

}  // namespace
}  // namespace lilytank
