// SIGINT, SIGTERM and SIGHUP request a clean stop.
#pragma once
#include <atomic>

namespace lilytank::cli {

/// Becomes true once a signal requests a stop. The first call installs the handlers; a second
/// signal then ends the process at once, as usual.
const std::atomic<bool>& stop_signal();

}  // namespace lilytank::cli
