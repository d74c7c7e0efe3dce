// A World is a constant Model, a State, and scratch memory; step() is all it does.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "lilytank/model.hpp"
#include "lilytank/state.hpp"

namespace lilytank {

enum class EventKind : std::uint8_t {
  latch,    ///< two faces met and hold
  unlatch,  ///< they let go: no applicable rule
  link,     ///< a rule made the latch a bond
  unlink,   ///< a rule released a bond
  update,   ///< a rule changed labels on a bond
  report,   ///< answer to a query: a module's state
  command,  ///< the base station spoke (a: command index)
};

/// Something that a module reported by radio, or the base station did, during a step.
struct Event {
  std::int64_t step = 0;
  EventKind kind = EventKind::latch;
  std::int32_t a = -1, b = -1;            ///< modules, -1: none
  std::int8_t face_a = -1, face_b = -1;   ///< their connectors
  std::int16_t rule = -1;                 ///< index into the ruleset
  std::int32_t label_a = 0, label_b = 0;  ///< l_a after the event
  std::int8_t last_a = -1, last_b = -1;   ///< l_n after the event
};

enum class RunStatus { ok, diverged, stopped };

/// Divergence::force of a world that was given up because one step took too much work: more
/// visits of contacts than Divergence::size. It stalled; nothing in it need have been fast.
inline constexpr std::string_view kStalled = "contact_solver";

/// Why a world was given up.
struct Divergence {
  std::int64_t step = 0;
  int body = 0;
  std::string_view force;  ///< the term with the largest force on that body, or kStalled
  double size = 0;         ///< N, its size; of kStalled: the visits allowed in one step
};

/// Counts of work done since the start of this object (not part of the state).
struct Tallies {
  std::int64_t evaluations = 0;    ///< exchanges completed
  std::int64_t snaps_refused = 0;  ///< latches put off because there was no room
  std::int64_t moves_undone = 0;   ///< bodies put back to keep overlap in bounds
  double deepest_overlap = 0;      ///< m
};

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
