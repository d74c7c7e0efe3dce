// Small models that many tests start from.
#pragma once
#include <memory>

#include "lilytank/model.hpp"
#include "lilytank/world.hpp"

namespace lilytank::test {

/// Water at rest, without gusts.
inline std::shared_ptr<const FlowField> still_water(double extent = 0.3) {
  return std::make_shared<const FlowField>(2, extent, std::vector<FlowSample>(4),
                                           std::vector<bool>(4, true), Interpolation::bilinear);
}

/// The same velocity everywhere, with a deviation.
inline std::shared_ptr<const FlowField> uniform_water(FlowSample sample, double extent = 0.3) {
  return std::make_shared<const FlowField>(2, extent, std::vector<FlowSample>(4, sample),
                                           std::vector<bool>(4, true), Interpolation::bilinear);
}

/// A term with its first parameters set; the rest keep their defaults.
inline ActiveForce force(std::string_view name, std::vector<double> values) {
  ActiveForce active = with_defaults(*find_force(name));
  std::copy(values.begin(), values.end(), active.p.begin());
  return active;
}

/// One module at a pose in still water, no forces, no latches.
inline Model lone_module(Pose pose = {}) {
  Model model;
  model.module.count = 1;
  model.field = still_water();
  model.control.latches = false;
  model.start.layout = Layout::poses;
  model.start.poses = {pose};
  return model;
}

/// Like standard_model(), with steps of kTick / k.
inline Model with_step(Model model, int k) {
  model.steps_per_tick = k;
  model.dt = kTick / k;
  return model;
}

/// Steps until `seconds` have passed; true if the world did not diverge.
inline bool advance(World& world, double seconds) {
  const auto steps = static_cast<std::int64_t>(seconds / world.model().dt + 0.5);
  for (std::int64_t i = 0; i < steps; ++i) {
    if (world.step() != RunStatus::ok) return false;
  }
  return true;
}

}  // namespace lilytank::test
