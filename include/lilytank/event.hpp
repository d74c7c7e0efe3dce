// What a step reports beside the new state: events, the cause of a divergence, counts of work.
// World (world.hpp) hands them out; controllers and the contact solver fill them in.
#pragma once
#include <cstdint>
#include <string_view>

namespace lilytank {

/// Kinds of events. Rules are those of the ruleset in force.
enum class EventKind : std::uint8_t {
  /// Two faces came within capture distance and angle and hold each other.
  latch,
  /// A new latch was released: no rule applies to the pair's labels.
  unlatch,
  /// A link rule made the latch a bond.
  link,
  /// An unlink rule released a bond.
  unlink,
  /// An update rule changed labels on a bond.
  update,
  /// A module answered a query with its state.
  report,
  /// The base station gave a command: command_at(model, Event::a).
  command,
};

/// Something that a module reported by radio, or the base station did, during a step. Fields that
/// do not apply to the kind keep their defaults.
struct Event {
  /// The step in which it happened; its time is step * dt.
  std::int64_t step = 0;
  EventKind kind = EventKind::latch;
  /// Modules; -1: none.
  std::int32_t a = -1, b = -1;
  /// Their connectors, 0..3; -1: none.
  std::int8_t face_a = -1, face_b = -1;
  /// Index into the rules of the ruleset in force; -1: none.
  std::int16_t rule = -1;
  /// Control states l_a after the event.
  std::int32_t label_a = 0, label_b = 0;
  /// Connectors engaged last, l_n, after the event; -1: isolated.
  std::int8_t last_a = -1, last_b = -1;
};

/// ok: go on. diverged: the state is not usable and nothing steps it further. stopped: a signal
/// or a caller ended the run early; the state is valid.
enum class RunStatus { ok, diverged, stopped };

/// Divergence::force of a simulation that was given up because one step took too much work: more
/// visits of contacts than Divergence::size. It stalled; nothing in it need have been fast.
inline constexpr std::string_view kStalled = "contact_solver";

/// Why a simulation was given up.
struct Divergence {
  std::int64_t step = 0;
  /// The fastest body, or one of the assembly that stalled.
  int body = 0;
  /// Name of the term with the largest force on that body's assembly; "none" if all are 0; or
  /// kStalled.
  std::string_view force;
  /// Size of that force, N. Of kStalled: the visits allowed in one step.
  double size = 0;
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
  /// Deepest overlap of any two bodies, or of a body and the wall, after any substep, m.
  double deepest_overlap = 0;
};

/// The deepest overlap in a state.
struct Overlap {
  /// m; 0: nothing overlaps.
  double depth = 0;
  /// Bodies, a < b; a = -1: b and the wall.
  int a = -1, b = -1;
};

}  // namespace lilytank
