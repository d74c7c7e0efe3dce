// The sum of all terms that are switched on: first what they do to the water, then their wrenches,
// then what changes the sum.
#pragma once
#include <memory>
#include <vector>

#include "forces/float_bodies.hpp"
#include "forces/kept_gusts.hpp"
#include "lilytank/force.hpp"
#include "lilytank/model.hpp"

namespace lilytank {

/// What is left of velocities and spins after `dt` s of all terms' damping.
Decay total_decay(const std::vector<ActiveForce>& forces, double dt);

/// Calls the terms of a list in the order of their stages. No allocation after it was made.
class ForceSum {
 public:
  /// `model` must outlive it; `forces` are the model's, or others in their place.
  explicit ForceSum(const Model& model) : ForceSum(model, model.forces) {}
  ForceSum(const Model& model, const std::vector<ActiveForce>& forces);

  /// `now` with what the terms make of the water at each body; it points into this object.
  void perturb_flow(const Kinematics& k, StepContext& now);
  /// Sets `out` [bodies] to the sum of all wrenches.
  void operator()(const Kinematics& k, StepContext now, std::span<Wrench> out);

  /// Whether the sum over a running world's bodies needs them in double precision as well: if a
  /// term has no in_lanes().
  bool needs_doubles() const { return !wrenches_.empty(); }
  /// Sets the wrenches of a running world's bodies to the sum of all. `k` are the same bodies; not
  /// read unless needs_doubles().
  void operator()(const FloatBodies& b, const Kinematics& k, StepContext now);

 private:
  const Model* model_;
  const std::vector<ActiveForce>* forces_;
  std::vector<const ActiveForce*> stirring_, transforming_;
  // [bodies] added to the water's velocity, m/s, and rotation, rad/s.
  std::vector<double> stirred_x_, stirred_y_, stirred_turning_, drag_;
  KeptGusts gusts_;
  std::vector<std::unique_ptr<LaneForce>> lanes_;  // [force]; null: in double precision
  std::vector<Wrench> wrenches_;                   // [bodies] of the terms in double precision
};

}  // namespace lilytank
