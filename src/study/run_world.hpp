// One run of a study, in memory.
#pragma once
#include <functional>

#include "lilytank/assembly_record.hpp"
#include "lilytank/study.hpp"

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

struct WorldRun {
  RunRow row;            ///< status, duration, possible, copies, illegal, completion, note
  double simulated = 0;  ///< s; row.duration is the planned end where the world was left early
};

/// Runs a scenario's world. `simulated` receives the simulated time (s) since its last call. Throws
/// Stopped, InputError if the bodies do not fit in the tank.
WorldRun run_world(const Scenario& scenario, std::uint64_t seed, EarlyEnd early,
                   const JobControl& control = {},
                   const std::function<void(double)>& simulated = {});

/// The same for a replicate of a study's setting, with the rest of its row.
WorldRun run_world(const Study& study, int setting, int replicate, const JobControl& control,
                   const std::function<void(double)>& simulated);

/// Whether all possible copies stand and no rule with p > 0 of any of the model's rulesets can
/// undo, relabel or add to one of their modules' bonds.
bool is_final(const World& world, const AssemblyRecord& record);

}  // namespace lilytank
