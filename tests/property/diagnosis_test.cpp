// A small tank diagnosed from begin to end: nothing is found where nothing is missing, what is
// planted is named, a law that no effect has is called unnamed.
#include <gtest/gtest.h>

#include "diagnose/diagnoser.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/model_parameter.hpp"

namespace lilytank {
namespace {

constexpr int kModules = 6, kFrames = 30 * 30 + 1;

Model small_tank() {
  Model model = standard_model();
  model.module.count = kModules, model.control.latches = false;
  model.steps_per_tick = 2, model.dt = kTick / 2;
  return model;
}

std::vector<Recording> filmed(const Model& model, std::uint64_t seed) {
  RecordingShape shape;
  shape.name = "simulated", shape.bodies = kModules, shape.frames = kFrames;
  EmulatorOptions options;
  options.moment_matched = false;
  return *Emulator(model, {}, {shape, shape, shape}, options).record({}, seed);
}

// Nulls and fingerprints of one tank serve all tests here.
class Diagnosed : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Experiment experiment;
    experiment.name = "small";
    experiment.base.model = small_tank();
    experiment.recordings = filmed(small_tank(), 11);
    DiagnosisOptions options;
    options.hold_out = 0, options.minutes = 1;
    diagnoser_ = new Diagnoser(experiment, options);
    diagnoser_->prepare();
  }
  static void TearDownTestSuite() { delete diagnoser_; }
  static Diagnosis of(const Model& model, std::uint64_t seed) {
    Diagnosis out;
    diagnoser_->judge(filmed(model, seed), out);
    return out;
  }
  static Diagnoser* diagnoser_;
};
Diagnoser* Diagnosed::diagnoser_ = nullptr;

TEST_F(Diagnosed, NothingIsFoundWhereNothingIsMissing) {
  for (const std::uint64_t seed : {21, 22, 23}) {
    const Diagnosis d = of(small_tank(), seed);
    EXPECT_EQ(d.verdict, Verdict::complete) << diagnosis_text(d);
    EXPECT_FALSE(d.detectable.empty());
  }
}

TEST_F(Diagnosed, APlantedTorqueIsNamed) {
  const std::vector<std::string> path{"forces.spin_torque.torque"};
  const Diagnosis d = of(with_parameters(small_tank(), path, std::vector<double>{1e-4}), 31);
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  EXPECT_EQ(d.findings.front().effect, "spin_torque") << diagnosis_text(d);
}

TEST_F(Diagnosed, APulsatingPumpIsNamed) {
  const std::vector<std::string> path{"forces.flow_pulsation.share"};
  const Diagnosis d = of(with_parameters(small_tank(), path, std::vector<double>{0.25}), 41);
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  EXPECT_EQ(d.findings.front().effect, "flow_pulsation") << diagnosis_text(d);
}

// A compass needle in every module: the curve over headings is found, no name is given.
TEST_F(Diagnosed, ALawOfNoEffectIsUnnamed) {
  Model model = small_tank();
  Shape compass;
  for (const Shape& s : diagnoser_->atlas().plan().shapes) {
    if (s.curve.along == Along::heading && s.curve.toward == Toward::torque) compass = s;
  }
  std::vector<double> values;
  for (int k = 0; k < kKnots; ++k) values.push_back(1.5e-4 * rotation(2 * kPi * k / kKnots).s);
  const Diagnosis d = of(with_effect(model, effect_of(compass), values), 51);
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  EXPECT_EQ(d.findings.front().effect, "unnamed") << diagnosis_text(d);
  EXPECT_EQ(d.findings.front().variable, "heading") << diagnosis_text(d);
}

}  // namespace
}  // namespace lilytank
