// The files that grow during a run: poses, events, metrics.
#pragma once
#include <memory>
#include <vector>

#include "io/append_file.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/assembly_record.hpp"

namespace lilytank {

/// Things that are due at regular times, each at the step nearest to its time.
class Schedule {
 public:
  /// `interval` in steps, at least 1. Nothing is due at or before step `done`.
  Schedule(double interval, std::int64_t done);
  /// Whether something is due at `step`; call for every step in turn.
  bool due(std::int64_t step);

 private:
  std::int64_t step_of(std::int64_t index) const;
  double interval_;
  std::int64_t next_ = 0;
};

class RunFiles {
 public:
  /// Begins the files, or goes on in those of a checkpoint, when `copies` stood.
  RunFiles(const Scenario& scenario, const RunDirectory& directory, int copies);

  /// Call once at the start and after every step, with the record brought up to date.
  void observe(const World& world, const AssemblyRecord& record);
  /// Call at the end: the last row of the metrics, if it was not due anyway.
  void finish(const World& world, const AssemblyRecord& record);
  /// Hands everything to the disk; returns what the files now hold.
  RunFileDigests flush();

 private:
  void events(const World& world, const AssemblyRecord& record);
  void metrics(const World& world, const AssemblyRecord& record);

  const Scenario* scenario_;
  std::unique_ptr<TrajectoryWriter> trajectory_;
  AppendFile events_, metrics_;
  Schedule frames_due_, metrics_due_;
  std::int64_t metrics_step_ = -1;  ///< of the last row
  int copies_;                      ///< as last written to the events
};

}  // namespace lilytank
