// One world from a scenario to files: the job behind `lilytank run`.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "lilytank/assembly_record.hpp"
#include "lilytank/report.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {

struct RunOptions {
  std::string out;     ///< directory, made if absent; empty: nothing is written
  bool force = false;  ///< replace another run's files
  const std::atomic<bool>* stop = nullptr;  ///< set by a signal: finish the step, keep everything
  std::function<void(double done, double rate)> progress;  ///< share done, simulated s per s
  double checkpoint_seconds = 20;                          ///< wall time between checkpoints
};

struct RunResult {
  RunStatus status = RunStatus::ok;
  double time = 0;                ///< s, simulated
  double wall = 0;                ///< s, of this call
  std::uint64_t fingerprint = 0;  ///< of the final state
  int copies = 0, possible = 0;
  std::vector<double> completion_times;  ///< s
  std::int64_t illegal = 0;
  Divergence divergence;
  bool resumed = false, already_complete = false;
};

/// Runs a scenario, or goes on with an interrupted run of the same scenario found in `out` and
/// ends in the same files, byte for byte. Throws InputError if `out` holds another run.
RunResult run(const Scenario& scenario, const RunOptions& options);

/// What `lilytank run` left in a directory, for rendering and analysis.
struct StoredRun {
  Scenario scenario;
  Trajectory trajectory;
  /// Rows of metrics.csv: time (s), copies standing, assemblies by size.
  std::vector<double> metrics_time;
  std::vector<int> metrics_copies;
};
StoredRun load_run(const std::string& dir);
/// The report of a finished run as a document: copies, assemblies, rules. Provenance is the
/// caller's. Throws InputError if a file of the run cannot be read.
ReportDocument run_report(const StoredRun& run, const std::string& dir);
/// Compares a run's scenario, events and metrics with its checkpoint. Throws InputError with the
/// file that was changed.
void check_stored_run(const std::string& dir);

}  // namespace lilytank
