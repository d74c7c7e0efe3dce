// One run of a study, in memory.
#pragma once
#include <atomic>
#include <functional>
#include <optional>

#include "lilytank/study.hpp"

namespace lilytank {

/// Runs a setting's world to its end; nothing if `stop` was set before. `simulated` is told how
/// much simulated time (s) has passed since it was last told. Throws InputError if the bodies do
/// not fit in the tank.
std::optional<RunRow> run_world(const Study& study, int setting, int replicate,
                                const std::atomic<bool>* stop,
                                const std::function<void(double)>& simulated);

}  // namespace lilytank
