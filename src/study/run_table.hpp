// Which runs of a study there are, and which are still wanted.
#pragma once
#include <string>
#include <vector>

#include "study/rounds.hpp"

namespace lilytank {

/// A run by its place in the study.
struct RunPlace {
  int setting = 0, replicate = 0;
};

class Ledger {
 public:
  explicit Ledger(const StudyPlan& plan);

  /// Takes a row in, unless it is there already.
  void add(RunRow row);
  /// What is wanted of a setting, from the rows of now.
  Wanted wanted(int setting) const;
  /// Wanted runs that are not there, replicate by replicate, so that all settings grow together.
  std::vector<RunPlace> missing() const;
  /// Every setting is decided and nothing is missing.
  bool complete() const;
  /// The rows below what is wanted of their setting, by setting and replicate.
  std::vector<const RunRow*> wanted_rows() const;
  /// Diverged runs among them.
  int failed() const;

 private:
  const StudyPlan* plan_;
  std::vector<std::vector<std::unique_ptr<RunRow>>> rows_;  ///< [setting][replicate]
};

}  // namespace lilytank
