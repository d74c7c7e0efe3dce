// The same binary, scenario and seed give the same bits, whatever runs beside them.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lilytank/random.hpp"
#include "lilytank/world.hpp"
#include "math/bulk_exp.hpp"
#include "support/scenes.hpp"

namespace lilytank {
namespace {

struct Scene {
  const char* name;
  Model model;
  double seconds;
  const char*
      golden;  ///< fingerprint after `seconds` with seed 42; a change of it is a new version
};

std::vector<Scene> scenes() {
  return {{"chain, firmware clock", test::chain_scene(Clock::firmware), 120, "3674c71333330d40"},
          {"chain, event clock", test::chain_scene(Clock::events), 120, "e11ebd68d3a4aa18"},
          {"balls and modules", test::mixed_scene(), 60, "1f261a6c6dd3e31f"},
          {"packed", test::packed_scene(), 5, "95e0e173628c3d35"},
          {"moment-matched gusts", test::drawn_scene(Gusts::moment_matched, FlowAt::points), 30,
           "f6ba4b5b5e19b4ca"},
          {"one gust a module", test::drawn_scene(Gusts::per_module, FlowAt::centre), 30,
           "ecbdff3980e5c618"},
          {"eddies and streams", test::stirred_scene(), 30, "9e5ee462ef456581"}};
}

std::string final_hash(const Model& model, std::uint64_t seed, double seconds) {
  World world(model, seed);
  test::advance(world, seconds);
  return hex(fingerprint(world.state()));
}

TEST(Determinism, GoldenFingerprints) {
  for (const Scene& scene : scenes())
    EXPECT_EQ(final_hash(scene.model, 42, scene.seconds), scene.golden) << scene.name;
}

// Calibrations and diagnoses are the same on every processor only if their matrices are cut into
// the same blocks; -1 is "not known, take what is usual".
TEST(Determinism, MatricesAreNotCutByTheProcessorsCaches) {
  int l1 = 0, l2 = 0, l3 = 0;
  Eigen::internal::queryCacheSizes(l1, l2, l3);
  EXPECT_EQ(l1, -1);
  EXPECT_EQ(l2, -1);
  EXPECT_EQ(l3, -1);
}

// The instruction sets that this machine has, down to the one that every x86-64 has: the best is
// taken unless it is told that there is none better.
template <class Use>
void with_each_instruction_set(Use&& use) {
  int sets = 0;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    hwy::GetChosenTarget().DeInit();
    use(hwy::TargetName(left & -left));
    ++sets;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  EXPECT_GE(sets, 1);
}

TEST(Determinism, EveryInstructionSetGivesTheSameBits) {
  with_each_instruction_set([](const char* set) {
    for (const Scene& scene : scenes())
      EXPECT_EQ(final_hash(scene.model, 42, scene.seconds), scene.golden)
          << scene.name << ", " << set;
  });
}

TEST(Determinism, EveryInstructionSetGivesTheSameExponentials) {
  std::vector<double> x;
  for (double at = -746; at < 711; at += 0.173) x.push_back(at);
  with_each_instruction_set([&](const char* set) {
    std::vector<double> out(x.size());
    bulk_exp(x.data(), static_cast<int>(x.size()), out.data());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(out[i], exp_portable(x[i])) << set;
  });
}

TEST(Determinism, SavingAndLoadingInTheMiddleChangesNothing) {
  for (const Scene& scene : scenes()) {
    World whole(scene.model, 7);
    ASSERT_TRUE(test::advance(whole, 3));
    const std::string bytes = to_snapshot(whole.state(), 11);
    World resumed(scene.model, from_snapshot(bytes, 11, "memory"));
    for (int step = 0; step < 200; ++step) {
      whole.step(), resumed.step();
      ASSERT_EQ(fingerprint(whole.state()), fingerprint(resumed.state()))
          << scene.name << ", step " << step;
    }
  }
}

// Wherever the world was before, diverged or not.
TEST(Determinism, AWorldThatGoesOnFromAnotherStateIsLikeANewOne) {
  for (const Scene& scene : scenes()) {
    World first(scene.model, 7), other(scene.model, 8);
    ASSERT_TRUE(test::advance(first, 3) && test::advance(other, 2));
    State lost = other.state();
    lost.vx[0] = 1e3;
    other.go_on_from(lost);
    ASSERT_EQ(other.step(), RunStatus::diverged) << scene.name;
    other.go_on_from(first.state());
    World fresh(scene.model, first.state());
    for (int step = 0; step < 100; ++step) {
      fresh.step(), other.step();
      ASSERT_EQ(fingerprint(fresh.state()), fingerprint(other.state()))
          << scene.name << ", step " << step;
    }
  }
}

// Side by side, with other companions in every step and one among them that diverges, worlds end
// as they do alone.
TEST(Determinism, ABatchGivesTheBitsOfWorldsAlone) {
  for (const Scene& scene : scenes()) {
    constexpr int kWorlds = 9;
    std::vector<World> alone, batched;
    for (int k = 0; k < kWorlds; ++k)
      alone.emplace_back(scene.model, 70 + k), batched.emplace_back(scene.model, 70 + k);
    State lost = batched[0].state();
    lost.vx[0] = std::nan("");
    World poisoned(scene.model, lost);
    Batch batch;
    const int steps = scene.model.bodies() > 50 ? 100 : 1000;
    for (int step = 0; step < steps; ++step) {
      std::vector<World*> together{&poisoned};
      for (int k = 0; k < kWorlds; ++k) {
        alone[k].step();
        together.push_back(&batched[(k * (step % 7 + 1)) % kWorlds]);
      }
      std::sort(together.begin(), together.end());
      together.erase(std::unique(together.begin(), together.end()), together.end());
      batch.step(together);
      for (World& world : batched)
        if (std::find(together.begin(), together.end(), &world) == together.end()) world.step();
      if (step == 5) poisoned.go_on_from(lost);
    }
    for (int k = 0; k < kWorlds; ++k) {
      EXPECT_EQ(fingerprint(batched[k].state()), fingerprint(alone[k].state()))
          << scene.name << ", " << k;
    }
  }
}

TEST(Determinism, SeedsMatter) {
  const Model model = test::chain_scene(Clock::firmware);
  EXPECT_NE(final_hash(model, 1, 1), final_hash(model, 2, 1));
}

TEST(Snapshot, RefusesWhatIsCutDamagedOrForeign) {
  const Model model = test::packed_scene();
  const State state = initial_state(model, 1);
  std::string bytes = to_snapshot(state, 5);
  EXPECT_EQ(fingerprint(from_snapshot(bytes, 5, "x")), fingerprint(state));
  EXPECT_THROW(from_snapshot(bytes, 6, "x"), InputError);
  EXPECT_THROW(from_snapshot(bytes.substr(0, bytes.size() - 3), 5, "x"), InputError);
  EXPECT_THROW(from_snapshot(bytes.substr(0, 12), 5, "x"), InputError);
  EXPECT_THROW(from_snapshot("", 5, "x"), InputError);
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_THROW(from_snapshot(bytes, 5, "x"), InputError);
}

}  // namespace
}  // namespace lilytank
