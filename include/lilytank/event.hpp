// What a step reports beside the new state: events, the cause of a divergence, counts of work.
// World (world.hpp) hands them out; controllers and the contact solver fill them in.
#pragma once
#include <cstdint>
#include <string_view>

namespace lilytank {

/// Kinds of events. Rules are those of the ruleset in force.
enum class EventKind : std::uint8_t {
  latch,    ///< two faces came within capture distance and angle and hold each other
  unlatch,  ///< a new latch was released: no rule applies to the pair's labels
  link,     ///< a link rule made the latch a bond
  unlink,   ///< an unlink rule released a bond
  update,   ///< an update rule changed labels on a bond
  report,   ///< a module answered a query with its state
  command,  ///< the base station gave a command: command_at(model, Event::a)
};

/// Something that a module reported by radio, or the base station did, during a step. Fields that
/// do not apply to the kind keep their defaults.
struct Event {
  std::int64_t step = 0;  ///< the step in which it happened; its time is step * dt
  EventKind kind = EventKind::latch;
  std::int32_t a = -1, b = -1;           ///< modules; -1: none
  std::int8_t face_a = -1, face_b = -1;  ///< their connectors, 0..3; -1: none
  std::int16_t rule = -1;                ///< index into the rules of the ruleset in force; -1: none
  std::int32_t label_a = 0, label_b = 0;  ///< control states l_a after the event
  /// Connectors engaged last, l_n, after the event; -1: isolated.
  std::int8_t last_a = -1, last_b = -1;
};

/// ok: go on. diverged: the state is not usable and nothing steps it further.
enum class RunStatus { ok, diverged };

/// Divergence::force of a simulation that was given up because one step took too much work: more
/// visits of contacts than Divergence::size. It stalled; nothing in it need have been fast.
inline constexpr std::string_view kStalled = "contact_solver";

/// Why a simulation was given up.
struct Divergence {
  std::int64_t step = 0;
  int body = 0;  ///< the fastest body, or one of the assembly that stalled
  /// Name of the term with the largest force on that body's assembly; "none" if all are 0; or
  /// kStalled.
  std::string_view force;
  double size = 0;  ///< size of that force, N. Of kStalled: the visits allowed in one step
};

/// Counts of work since a World was made. Not part of the state: a run that resumes adds those of
/// its checkpoint.
struct Tallies {
  /// Completed exchanges between two modules, whether or not a rule fired.
  std::int64_t evaluations = 0;
  /// Latches put off because the modules had no room on their common lattice.
  std::int64_t snaps_refused = 0;
  /// Bodies put back to where they were before a substep, to keep overlap within bounds.
  std::int64_t moves_undone = 0;
  /// Deepest overlap of any two bodies, or of a body and the wall, after any substep, m, of
  /// those that were solved together: between others up to 0.08 mm are left alone and may be
  /// missed.
  double deepest_overlap = 0;
};

/// The deepest overlap in a state.
struct Overlap {
  double depth = 0;    ///< m; 0: nothing overlaps
  int a = -1, b = -1;  ///< bodies, a < b; a = -1: b and the wall
};

}  // namespace lilytank
