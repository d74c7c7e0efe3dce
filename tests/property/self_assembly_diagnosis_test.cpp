// Recordings of self-assembly diagnosed: nothing is found where nothing is missing, and a fault of
// the modules' control is named.
#include <gtest/gtest.h>

#include "finder/fitted_model.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/ruleset.hpp"

namespace lilytank {
namespace {

constexpr int kLilies = 10;

Model assembling_tank() {
  Model model = standard_model();
  model.module.count = kLilies;
  model.rulesets = {read_ruleset(LILYTANK_SOURCE_DIR "/scenarios/rulesets/chain5.rules")};
  model.steps_per_tick = 2, model.dt = kTick / 2;
  return model;
}

// Three recordings that begin with single modules, with the log of their radio.
std::vector<Recording> assembly_films(const Model& model, double seconds, std::uint64_t seed) {
  RecordingShape shape;
  shape.name = "simulated", shape.bodies = kLilies, shape.latches = shape.logged = true;
  shape.frames = static_cast<int>(std::lround(30 * seconds)) + 1;
  EmulatorOptions options;
  options.moment_matched = false;
  return *Emulator(model, {}, {shape, shape, shape}, options).record({}, seed);
}

Diagnosis answer(PreparedTank& tank, const Model& model, double seconds, std::uint64_t seed) {
  Diagnosis out;
  judge(tank, assembly_films(model, seconds, seed), out);
  return out;
}

Model faulty(const std::string& path, double value) {
  return with_parameters(assembling_tank(), std::vector<std::string>{path},
                         std::vector<double>{value});
}

Experiment assembly_experiment(double seconds) {
  Experiment experiment;
  experiment.name = "self-assembly", experiment.base.model = assembling_tank();
  experiment.recordings = assembly_films(assembling_tank(), seconds, 11);
  return experiment;
}

DiagnosisOptions small_budget() {
  DiagnosisOptions options;
  options.hold_out = 0, options.minutes = 1;
  return options;
}

TEST(LongSelfAssembly, FaultsOfTheControlAreNamed) {
  constexpr double kSeconds = 90;
  DiagnosisSetup setup(assembly_experiment(kSeconds), small_budget());
  PreparedTank tank(setup);
  for (const std::uint64_t seed : {21, 22}) {
    const Diagnosis d = answer(tank, assembling_tank(), kSeconds, seed);
    EXPECT_EQ(d.verdict, Verdict::complete) << diagnosis_text(d);
  }
  const Diagnosis torque = answer(tank, faulty("forces.spin_torque.torque", 2e-4), kSeconds, 31);
  ASSERT_EQ(torque.verdict, Verdict::missing) << diagnosis_text(torque);
  EXPECT_EQ(torque.findings.front().effect, "spin_torque") << diagnosis_text(torque);
  const Diagnosis holds = answer(tank, faulty("control.release_failure", 0.8), kSeconds, 41);
  ASSERT_EQ(holds.verdict, Verdict::missing) << diagnosis_text(holds);
  EXPECT_EQ(holds.findings.front().effect, "release_failure") << diagnosis_text(holds);
}

}  // namespace
}  // namespace lilytank
