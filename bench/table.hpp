// Results as tables: one of worlds, one of other engines beside ours.
#pragma once
#include <benchmark/benchmark.h>

namespace lilytank::bench {

/// Prints a row for each benchmark as it ends.
class TableReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override;

 private:
  void world_row(const Run& run);
  void contest_row(const Run& run);
  bool worlds_begun_ = false, contests_begun_ = false;
};

}  // namespace lilytank::bench
