// The simulator: a World is a constant Model, a State, and scratch memory; step() advances it.
//
//   const Model model = standard_model();
//   World world(model, seed);
//   while (world.time() < 60 && world.step() == RunStatus::ok) record.observe(world);
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "lilytank/event.hpp"
#include "lilytank/model.hpp"
#include "lilytank/start.hpp"
#include "lilytank/state.hpp"

namespace lilytank {

/// One simulation. A World may move between threads but not be shared by them; any number of
/// Worlds may share a Model. No allocation after the first step; scratch
/// memory belongs to the thread.
class World {
 public:
  /// Begins from initial_state(model, seed). `model` must outlive the World. Throws InputError if
  /// the bodies do not fit.
  World(const Model& model, std::uint64_t seed);
  /// Continues from a state of the same model: step by step the same bits as the simulation that
  /// the state was copied from.
  World(const Model& model, State state);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  /// Continues from another state of the same model, as a new World would, but allocates nothing:
  /// for many short simulations in a row.
  void go_on_from(const State& state);

  /// Advances by dt: forces, controllers, velocities and contacts, positions, damping (the order of
  /// the model, docs/structure.md). Semi-implicit Euler, first order in dt. Returns diverged, and
  /// does nothing further, once a number is not finite, a body exceeds 20 m/s, or the
  /// contacts of one step take more work than is allowed (kStalled). Never throws.
  RunStatus step();
  /// What the last step returned; ok before the first.
  RunStatus status() const;

  /// The model given at the start.
  const Model& model() const;
  /// The state after the last step: a copy is a checkpoint. Poses and twists are float32 numbers.
  const State& state() const;
  /// The same at no cost, but poses and twists may be those of an earlier step: for what modules
  /// say and hold.
  const State& firmware() const;
  /// Steps of dt since the start: state().step, at no cost.
  std::int64_t steps() const;
  /// Simulated time since step 0, s: step * dt.
  double time() const;
  /// Poses and twists of all bodies at the end of the last step. The spans follow the
  /// simulation and stay valid as long as it lives.
  const Kinematics& kinematics() const;
  /// Events of the last step, in order. Valid until the next step.
  std::span<const Event> events() const;
  /// Meaningful once step() has returned diverged.
  const Divergence& divergence() const;
  /// Since this World was made or last set to another state.
  const Tallies& tallies() const;

 private:
  friend class Batch;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Steps many Worlds side by side, with the results that each has alone: up to a fifth faster where
/// islands of many Worlds meet in vector lanes (docs/performance.md). Holds scratch memory only, so
/// the Worlds may be others in every step.
class Batch {
 public:
  Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;
  ~Batch();

  /// Calls step() of every World, whatever their models, seeds and times. A World that diverged
  /// rests. Never throws.
  void step(std::span<World* const> worlds);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lilytank
