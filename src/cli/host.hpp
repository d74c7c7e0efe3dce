// Who runs a verb: the command-line program, or one that calls verbs in its own process, as the
// Python module does.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "lilytank/report.hpp"

namespace lilytank::cli {

/// Stops the jobs of verbs, and receives their progress and reports. As it is, the command-line
/// program: signals stop jobs, and their progress goes to stderr.
struct Host {
  const std::atomic<bool>* stop = nullptr;                             ///< instead of signals
  std::function<void(double done, const std::string& note)> progress;  ///< instead of stderr
  std::function<void(const ReportDocument& report)> report;
};

}  // namespace lilytank::cli
