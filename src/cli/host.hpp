// A program that calls the verbs in its own process, as the Python module does.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "lilytank/report.hpp"

namespace lilytank::cli {

/// Stops the jobs of verbs, and receives their progress and reports. Signals and the terminal are
/// the program's own.
struct Host {
  const std::atomic<bool>* stop = nullptr;
  std::function<void(double done, const std::string& note)> progress;
  std::function<void(const ReportDocument& report)> report;
};

/// Null in the command-line program. Of the process, as its streams and signals are: one verb at a
/// time acts in it.
inline const Host* host = nullptr;

}  // namespace lilytank::cli
