// The simpler method that a proof is measured against does what it is known to do: it finds a force
// that is far stronger than its noise, and it finds something where nothing is.
#include <gtest/gtest.h>

#include "lilytank/emulator.hpp"
#include "lilytank/model_parameter.hpp"
#include "proof/baseline_method.hpp"

namespace lilytank {
namespace {

Model small_tank() {
  Model model = standard_model();
  model.module.count = 6, model.control.latches = false;
  return model;
}

std::vector<Recording> filmed(const Model& model) {
  RecordingShape shape;
  shape.name = "simulated", shape.bodies = 6, shape.frames = 20 * 30 + 1;
  return *Emulator(model, {}, {shape}).record({}, 3);
}

ScorePlan plan_of(const Model& model) {
  ScorePlan plan;
  plan.model = model;
  for (const Effect& e : effect_catalogue(model)) {
    if (e.name == "spin_torque" || e.name == "self_propulsion") plan.effects.push_back(e);
  }
  plan.modules = 6;
  return plan;
}

TEST(SparseRegression, FindsWhatIsStrong) {
  const Model model =
      with_parameters(small_tank(), std::vector<std::string>{"forces.self_propulsion.force_x"},
                      std::vector<double>{0.02});
  const ScorePlan plan = plan_of(small_tank());
  const KeptTerm kept = sparse_regression(plan, filmed(model));
  ASSERT_GE(kept.effect, 0);
  EXPECT_EQ(plan.effects[static_cast<std::size_t>(kept.effect)].name, "self_propulsion");
}

TEST(SparseRegression, KeepsNothingOfFewFrames) {
  RecordingShape shape;
  shape.name = "short", shape.bodies = 6, shape.frames = 3;
  const auto made = Emulator(small_tank(), {}, {shape}).record({}, 5);
  EXPECT_EQ(sparse_regression(plan_of(small_tank()), *made).effect, -1);
}

// A camera that leans sees what is on its own side larger.
TEST(Emulator, FilmsThroughALeaningCamera) {
  RecordingShape shape;
  shape.name = "seen", shape.bodies = 6, shape.frames = 31;
  EmulatorOptions still;
  still.position_noise = 0;
  const std::vector<std::string> paths{kTiltX, kLens};
  const Emulator emulator(small_tank(), paths, {shape}, still);
  const auto plain = emulator.record(std::vector<double>{0, 0}, 7);
  const auto tilted = emulator.record(std::vector<double>{0.1, 0}, 7);
  const auto curved = emulator.record(std::vector<double>{0, 0.5}, 7);
  for (std::size_t i = 0; i < 6; ++i) {
    const double x = plain->front().tracks[i].x[0], y = plain->front().tracks[i].y[0];
    EXPECT_NEAR(tilted->front().tracks[i].x[0], x * std::cos(0.1) / (1 - x * std::sin(0.1)), 1e-6);
    EXPECT_NEAR(curved->front().tracks[i].y[0], y * (1 + 0.5 * (x * x + y * y)), 1e-6);
  }
  EXPECT_THROW(Emulator(small_tank(), {"camera.zoom"}, {shape}), InputError);
}

}  // namespace
}  // namespace lilytank
