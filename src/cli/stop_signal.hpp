// SIGINT and SIGTERM ask for a clean stop.
#pragma once
#include <atomic>

namespace lilytank::cli {

/// Becomes true once the process is asked to stop. The first call installs the handlers; a second
/// signal then ends the process at once, as usual.
const std::atomic<bool>& stop_signal();

}  // namespace lilytank::cli
