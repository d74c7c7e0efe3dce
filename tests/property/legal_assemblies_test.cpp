// Whole tanks: whatever the water does, the modules build nothing that their rules do not allow.
#include <gtest/gtest.h>

#include "lilytank/assembly_record.hpp"
#include "lilytank/random.hpp"
#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::test::ruleset_file;
using lilytank::test::shipped_rulesets;

namespace {

/// Frequent undoing for the first two joins, as the paper's optimum has it: much happens.
Ruleset lively(const std::string& name) {
  Ruleset rules = read_ruleset(ruleset_file(name));
  const std::size_t joins = rules.rules.size() / 2;
  for (std::size_t k = 0; k < joins; ++k)
    rules.rules[joins + k].p = k + 1 == joins ? 0.05 : k < 2 ? 0.4 : 0.1;
  return rules;
}

void expect_consistent(const State& state) {
  for (std::size_t k = 0; k < state.faces.size(); ++k) {
    const Face& face = state.faces[k];
    const bool held = face.status == FaceStatus::latched || face.status == FaceStatus::bonded;
    ASSERT_EQ(held, face.partner >= 0);
    if (!held) continue;
    const Face& other = state.faces[4 * static_cast<std::size_t>(face.partner) + face.partner_face];
    ASSERT_EQ(other.partner, static_cast<int>(k / 4));
    ASSERT_EQ(other.partner_face, k % 4);
    ASSERT_EQ(other.status, face.status);
    ASSERT_EQ(state.assembly[k / 4], state.assembly[static_cast<std::size_t>(face.partner)]);
  }
  for (const Firmware& firmware : state.firmware) ASSERT_EQ(firmware.label == 0, firmware.last < 0);
}

TEST(LegalAssemblies, TenMinutesOfEveryShippedRuleset) {
  std::int64_t firings = 0;
  for (const std::string& name : shipped_rulesets()) {
    for (const Clock clock : {Clock::firmware, Clock::events}) {
      Model model = standard_model();
      model.rulesets = {lively(name)};
      model.control.clock = clock;
      World world(model, 3);
      AssemblyRecord record(model);
      for (int step = 0; step < 24000; ++step) {
        ASSERT_EQ(world.step(), RunStatus::ok);
        record.observe(world);
        if (!world.events().empty()) expect_consistent(world.state());
        if (HasFatalFailure()) return;
      }
      EXPECT_EQ(record.illegal(), 0) << name;
      int modules = 0;
      for (std::size_t n = 1; n < record.by_size().size(); ++n)
        modules += static_cast<int>(n) * record.by_size()[n];
      EXPECT_EQ(modules, 15);
      for (const std::int64_t fired : record.firings()[0]) firings += fired;
    }
  }
  EXPECT_GT(firings, 1000);  // the tanks were not asleep
}

/// A crowded tank with faults drawn at random; every loss up to 0.9.
Model faulty_tank(std::uint32_t k) {
  const auto u = [&](std::uint32_t index) { return uniform({77, Stream::fault, 0, k, index}); };
  Model model = standard_model();
  const auto& names = shipped_rulesets();
  model.rulesets = {lively(names[k % names.size()])};
  model.module.count = 20 + static_cast<int>(30 * u(0));
  model.start.radius = 0.27, model.start.distance = 0.05;
  model.start.layout = Layout::lattice;
  ControlParameters& c = model.control;
  c.clock = u(1) < 0.5 ? Clock::firmware : Clock::events;
  c.evaluation_rate = 0.68 + 10 * u(2), c.initiative = 0.1 + 0.4 * u(3);
  c.reply_ticks = 1 + static_cast<int>(8 * u(4));
  c.answer_loss = 0.9 * u(5);
  if (u(6) < 0.5) c.message_loss = 0.9 * u(7);
  if (u(8) < 0.5) c.latch_failure = 0.9 * u(9);
  if (u(10) < 0.5) c.release_failure = 0.9 * u(11);
  return model;
}

std::int64_t illegal_in(const Model& model, std::uint32_t k, std::int64_t& firings) {
  World world(model, k);
  AssemblyRecord record(model);
  record.observe(world);
  for (int step = 0; step < 1200; ++step) {
    EXPECT_EQ(world.step(), RunStatus::ok);
    record.observe(world);
    if (!world.events().empty()) expect_consistent(world.state());
  }
  for (const std::int64_t fired : record.firings()[0]) firings += fired;
  return record.illegal();
}

TEST(LegalAssemblies, TheConfirmedHandshakeSurvivesEveryLoss) {
  std::int64_t firings = 0, plain_firings = 0, plain_illegal = 0;
  for (std::uint32_t k = 0; k < 90; ++k) {
    Model model = faulty_tank(k);
    if (k < 9) plain_illegal += illegal_in(model, k, plain_firings);
    model.control.handshake = Handshake::confirmed;
    EXPECT_EQ(illegal_in(model, k, firings), 0) << k;
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(firings, 1000);
  EXPECT_GT(plain_illegal, 0);  // these tanks do show what a lost answer can do
}

}  // namespace
