// What one tick of the modules' firmware works on.
#pragma once
#include <cstdint>
#include <vector>

#include "lilytank/event.hpp"
#include "lilytank/state.hpp"
#include "physics/assembly.hpp"
#include "physics/motion.hpp"

namespace lilytank {

/// All that may be read and changed during one tick of 25 ms, handed from part to part.
struct Tick {
  const Model& model;
  State& state;
  Assemblies& assemblies;
  Bodies& bodies;  ///< poses and twists as they are
  Motion& motion;
  Movers& movers;
  std::vector<Event>& events;
  Tallies& tallies;
  std::int64_t number;  ///< ticks since the start

  /// Brings poses and twists of `state` and `assemblies` up to date: before assemblies change.
  void fetch() { bodies.save(state, assemblies); }
  /// Takes over those of `state`: after assemblies changed.
  void commit() { bodies.load(state, assemblies); }
  bool on(int module) const { return state.firmware[module].power == Power::on; }
};

/// One connector of one module.
struct Connector {
  std::int32_t module = -1;
  std::int32_t face = 0;
};

inline Face& face_of(State& state, Connector at) {
  return state.faces[4 * at.module + at.face];
}
inline bool holds(const Face& face) {
  return face.partner >= 0;
}

/// A face as new: enabled, free, no message.
void clear_face(State& state, Connector at);
/// Makes two faces hold each other as a new latch. No event, and the assemblies stay as they are.
void hold(State& state, Connector a, Connector b);
/// Two faces that hold each other let go: both are off from now on, and the assembly falls into
/// its parts. No event; labels are the caller's.
void release(Tick& tick, Connector a, Connector b);
enum class Fault : std::uint32_t { message, answer, latch, release, acknowledgement };
/// Whether that fault [ControlParameters] happens at a connector in this tick.
bool fails(const Tick& tick, Connector at, Fault fault);
/// Reports what happened between two modules, the lower one first, with their states as they are.
void report(Tick& tick, EventKind kind, Connector a, Connector b, int rule = -1);

}  // namespace lilytank
