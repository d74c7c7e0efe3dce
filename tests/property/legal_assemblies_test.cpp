// Whole tanks: whatever the water does, the modules build nothing that their rules do not allow.
#include <gtest/gtest.h>

#include "lilytank/assembly_record.hpp"
#include "support/control_rig.hpp"

using namespace lilytank;
using lilytank::testing::ruleset_file;
using lilytank::testing::shipped_rulesets;

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

}  // namespace
