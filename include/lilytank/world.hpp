// A World is a constant Model, a State, and scratch memory; step() is all it does.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "lilytank/event.hpp"
#include "lilytank/model.hpp"
#include "lilytank/start.hpp"
#include "lilytank/state.hpp"

namespace lilytank {

/// One tank. Not shared between threads; the Model may be. No allocation after the first step.
class World {
 public:
  /// A new world: initial_state(model, seed). `model` must outlive the world.
  World(const Model& model, std::uint64_t seed);
  /// Goes on from a state of the same model.
  World(const Model& model, State state);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  /// Goes on from another state of the same model, as a new world would, but allocates nothing.
  void go_on_from(const State& state);

  /// Advances by dt: forces, controllers, velocities and contacts, positions, damping. Returns
  /// diverged, and does nothing further, once a number is not finite, a body exceeds 20 m/s, or the
  /// contacts of one step take more work than is allowed (kStalled).
  RunStatus step();

  const Model& model() const;
  const State& state() const;
  double time() const;  ///< s
  /// Poses and twists of all bodies at the end of the last step.
  const Kinematics& kinematics() const;
  /// What happened in the last step, in order.
  std::span<const Event> events() const;
  /// Meaningful once step() has returned diverged.
  const Divergence& divergence() const;
  const Tallies& tallies() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lilytank
