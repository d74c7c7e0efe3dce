// The bodies of a running world as the hot force terms take them: float32, without conversions.
#pragma once
#include <cstdint>
#include <span>

#include "lilytank/force.hpp"

namespace lilytank {

struct DragSettings;

/// Arrays aligned to 64 bytes and padded to a multiple of sixteen bodies; as in Kinematics.
struct FloatBodies {
  const float *x, *y, *c, *s, *vx, *vy, *omega;
  const std::uint8_t* covered;
  float *fx, *fy, *torque;  ///< wrenches, which terms add to
  int modules, count;
};

/// The same as face_drag().add(). `settings` were made for the model.
void add_face_drag(const Model& model, const FloatBodies& b, const StepContext& now,
                   std::span<const double> p, DragSettings& settings);
/// The same as stochastic_force().add().
void add_stochastic_force(const Model& model, const FloatBodies& b, const StepContext& now,
                          std::span<const double> p);

}  // namespace lilytank
