// What one step reports beside the new state: events, the reason of a divergence, counts of work.
#pragma once
#include <cstdint>
#include <string_view>

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

/// The deepest overlap of a state.
struct Overlap {
  double depth = 0;    ///< m; 0: nothing overlaps
  int a = -1, b = -1;  ///< bodies, a < b; a = -1: b and the wall
};

}  // namespace lilytank
