// The finished runs of a study, and those still to be made.
#pragma once
#include <string>
#include <vector>

#include "study/rounds.hpp"

namespace lilytank {

/// A run by its place in the study.
struct RunPlace {
  int setting = 0, replicate = 0;
};

/// Rows of finished runs by setting and replicate.
class RunTable {
 public:
  explicit RunTable(const StudyPlan& plan);

  /// Adds a row; a second one of the same run is ignored.
  void add(RunRow row);
  /// Replicates that a setting requires, given the present rows.
  RequiredRuns required(int setting) const;
  /// Required runs without a row, replicate by replicate, so that all settings grow together.
  std::vector<RunPlace> missing() const;
  /// Whether every setting is decided and every required run has a row.
  bool complete() const;
  /// Rows of required runs, by setting and replicate.
  std::vector<const RunRow*> required_rows() const;
  /// Diverged runs among them.
  int failed() const;

 private:
  const StudyPlan* plan_;
  std::vector<std::vector<std::unique_ptr<RunRow>>> rows_;  ///< [setting][replicate]
};

}  // namespace lilytank
