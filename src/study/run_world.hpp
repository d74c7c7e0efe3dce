// One run of a study, in memory.
#pragma once
#include <functional>

#include "jobs/early_end.hpp"
#include "lilytank/study.hpp"

namespace lilytank {

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

}  // namespace lilytank
