// Modules filmed in the built-in tank, and what is measured of them.
#pragma once
#include <vector>

#include "lilytank/emulator.hpp"
#include "scores/scores.hpp"
#include "support/worlds.hpp"

namespace lilytank::test {

// Modules far from each other in the built-in tank, without latches.
inline Model drifting(int modules) {
  Model model = standard_model();
  model.module.count = modules;
  model.control.latches = false;
  model.steps_per_tick = 5, model.dt = kTick / 5;
  return model;
}

inline std::vector<Recording> filmed(const Model& model, double seconds, std::uint64_t seed) {
  RecordingShape shape;
  shape.name = "simulated", shape.bodies = model.module.count;
  shape.frames = static_cast<int>(30 * seconds) + 1;
  const Emulator emulator(model, {}, {shape}, {});
  return *emulator.record({}, seed);
}

inline ScorePlan plan_for(const Model& model, const std::vector<Recording>& recordings) {
  ScorePlan plan;
  plan.model = model;
  plan.predictor = predictor_options(model, recordings);
  plan.effects = effect_catalogue(model);
  plan.shapes = shape_catalogue(model, 60);
  plan.modules = model.module.count;
  return plan;
}

}  // namespace lilytank::test
