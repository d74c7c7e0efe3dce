// Ends of a simulation before its planned end, of runs, studies and searches. They depend on the
// state and its events only, so that an interrupted run ends at the same step.
#pragma once
#include <cstdint>
#include <string>

#include "lilytank/assembly_record.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {

/// When a world is left before its planned end.
enum class EarlyEnd {
  never,
  /// As soon as all possible copies stand and no rule, of any of the model's rulesets, can change
  /// them any more: a row then says what it would have said at the end.
  settled,
  /// As soon as all possible copies have stood: nothing can be added to RunRow::completion.
  completed,
};

/// Whether all possible copies stand and no rule with p > 0 of any of the model's rulesets can
/// undo, relabel or add to one of their modules' bonds.
bool is_final(const World& world, const AssemblyRecord& record);

/// Whether the world may be left. Call after a step with events: copies change with events only.
bool over(EarlyEnd early, const World& world, const AssemblyRecord& record);

/// Number of steps in run.duration.
std::int64_t planned_steps(const Scenario& scenario);

/// Whether a condition of Scenario::end holds after the last step. `last_event` is the last step
/// with an event; 0: none yet.
bool over(const Scenario& scenario, const World& world, const AssemblyRecord& record,
          std::int64_t last_event);

/// For jobs over runs of equal duration. Throws InputError at the key that set a condition of
/// Scenario::end, with what the job does `instead`.
void refuse_early_end(const Scenario& scenario, const std::string& instead);

/// Why a run that is over ended: "3 of 3 copies completed at 623.4 s".
std::string end_text(const Scenario& scenario, const World& world, const AssemblyRecord& record);

}  // namespace lilytank
