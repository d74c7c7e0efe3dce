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
  std::string id;     ///< 16 hex digits: a function of the resolved scenario and the seed
  int setting = 0;    ///< which combination of the axes' values, from 0
  int replicate = 0;  ///< from 0; equal replicates of all settings share a seed
  std::uint64_t seed = 0;
  RunStatus status = RunStatus::ok;
  std::vector<double> values;  ///< of the axes, in their order; units as in Setting::texts
  double duration = 0;         ///< s, simulated
  int possible = 0;            ///< copies that the modules could make
  int copies = 0;              ///< standing at the end
  std::int64_t illegal = 0;
  std::vector<double> completion;  ///< s, when 1, 2, ... copies first stood
  std::string note;                ///< of a diverged run: step, body, force
};

/// A study's rows, sorted by setting and replicate.
struct StudyTable {
  std::string name;
  std::vector<std::string> axes;    ///< dotted paths
  std::vector<std::string> labels;  ///< one a setting, for legends
  double horizon = 0;               ///< s, the longest duration asked for
  std::vector<RunRow> rows;
};

}  // namespace lilytank
