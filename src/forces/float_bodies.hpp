// The bodies of a running world as the hot force terms take them: float32, without conversions.
#pragma once
#include <cstdint>

#include "lilytank/force.hpp"

namespace lilytank {

/// Arrays aligned to 64 bytes and padded to a multiple of sixteen bodies; as in Kinematics.
struct FloatBodies {
  const float *x, *y, *c, *s, *vx, *vy, *omega;
  const std::uint8_t* covered;
  float *fx, *fy, *torque;  ///< wrenches, which terms add to
  int modules, count;
};

/// What a term adds to the wrenches of one world's bodies; the base adds nothing.
class LaneForce {
 public:
  virtual ~LaneForce() = default;
  /// Never throws, never allocates.
  virtual void add(const FloatBodies& b, const StepContext& now) {
    static_cast<void>(b), static_cast<void>(now);
  }
};

}  // namespace lilytank
