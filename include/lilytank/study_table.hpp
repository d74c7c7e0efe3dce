// The results of a study: one row a run, whoever ran it and in whatever order.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lilytank/world.hpp"

namespace lilytank {

/// One finished world of a study.
struct RunRow {
  /// 16 hexadecimal digits: a function of the resolved scenario and the seed.
  std::string id;
  /// Which combination of the axes' values, from 0.
  int setting = 0;
  /// From 0; equal replicates of all settings share a seed.
  int replicate = 0;
  /// Seed of the run; below 2^59.
  std::uint64_t seed = 0;
  /// diverged: `note` says why, and statistics leave the run out.
  RunStatus status = RunStatus::ok;
  /// [axes] Values of the axes; units as in Setting::texts.
  std::vector<double> values;
  /// Simulated time, s: the setting's, unless the run diverged.
  double duration = 0;
  /// Largest number of copies that the modules can form.
  int possible = 0;
  /// Copies that stand at the end.
  int copies = 0;
  /// Appearances of assemblies that the rules cannot make; 0 for a correct simulation.
  std::int64_t illegal = 0;
  /// When 1, 2, ... copies first stood, s.
  std::vector<double> completion;
  /// Of a diverged run: step, body and force; else empty.
  std::string note;
};

/// A study's rows, sorted by setting and replicate.
struct StudyTable {
  /// Name of the study.
  std::string name;
  /// Dotted paths, or names of overlay axes.
  std::vector<std::string> axes;
  std::vector<std::string> labels;  ///< one a setting, for legends
  /// Longest duration of a setting, s: where survival curves end.
  double horizon = 0;
  /// Finished runs; a study that is not complete has fewer.
  std::vector<RunRow> rows;
};

}  // namespace lilytank
