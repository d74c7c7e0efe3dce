// One world from a scenario to files: the job behind `lilytank run`.
#pragma once
#include <memory>
#include <string>

#include "lilytank/assembly_record.hpp"
#include "lilytank/job_control.hpp"
#include "lilytank/report.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {

class DirectoryLock;

/// Where a run is kept, and how it is interrupted.
struct RunOptions : JobControl {
  /// Directory, made if absent; empty: nothing is written.
  std::string out;
  /// Replace another run's files.
  bool force = false;
  /// Receives the lock of the directory, for a caller who writes more there; null: the lock ends
  /// with the call.
  std::shared_ptr<const DirectoryLock>* lock = nullptr;
  /// Wall time between checkpoints, s. A kill loses no more than this.
  double checkpoint_seconds = 20;
};

/// How a run ended.
struct RunResult {
  /// ok or diverged (`divergence` says why).
  RunStatus status = RunStatus::ok;
  /// Simulated time reached, s.
  double time = 0;
  /// Wall time of this call, s.
  double wall = 0;
  /// Fingerprint of the final state: equal for equal scenarios and seeds.
  std::uint64_t fingerprint = 0;
  /// Copies of the target that stand at the end, and the most that the modules can form.
  int copies = 0, possible = 0;
  /// When 1, 2, ... copies first stood, s.
  std::vector<double> completion_times;
  /// As AssemblyRecord::illegal().
  std::int64_t illegal = 0;
  Divergence divergence;
  /// Whether the call continued an interrupted run, or found it finished and did nothing.
  bool resumed = false, already_complete = false;
};

/// Runs a scenario, or goes on with an interrupted run of the same scenario found in `out` and
/// ends in the same files, byte for byte. Throws Stopped after a step and its checkpoint,
/// InputError if `out` holds another run.
RunResult run(const Scenario& scenario, const RunOptions& options);

/// What `lilytank run` left in a directory, for rendering and analysis.
struct StoredRun {
  Scenario scenario;
  /// Empty if the scenario stores no poses.
  Trajectory trajectory;
  /// Rows of metrics.csv: time (s), copies standing, assemblies by size.
  std::vector<double> metrics_time;
  std::vector<int> metrics_copies;
};
/// Reads a run. Throws InputError if the directory holds none, a file is damaged, or the scenario
/// was changed since the run began.
StoredRun load_run(const std::string& dir);
/// The report of a finished run as a document: copies, assemblies, rules. Provenance is the
/// caller's. Throws InputError if a file of the run cannot be read.
ReportDocument run_report(const StoredRun& run, const std::string& dir);
/// Compares a run's scenario, events and metrics with its checkpoint. Throws InputError with the
/// file that was changed.
void check_stored_run(const std::string& dir);

}  // namespace lilytank
