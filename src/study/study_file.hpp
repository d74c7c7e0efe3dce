// Study files as their authors wrote them, before any scenario is built.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/scenario_layers.hpp"
#include "io/toml_key.hpp"
#include "lilytank/study.hpp"

namespace lilytank {

/// Numbers between two ends.
struct AxisRange {
  double from = 0, to = 0;  ///< SI units
  int count = 0;            ///< values, both ends included; unused for `latin`
  bool log = false;         ///< equal ratios instead of equal steps
  bool latin = false;  ///< one random value in each of as many equal parts as there are samples
  bool whole = false;  ///< the key is a whole number: values are rounded
};

/// What is varied: values of a path, or files laid over the scenario.
struct StudyAxis {
  std::string name;                   ///< the path, unless the file gives another name
  SourcePlace place;                  ///< of its table
  Assignment path;                    ///< keys and places; no keys: an axis of overlays
  std::vector<Assignment> values;     ///< where they are listed
  std::optional<AxisRange> range;     ///< where they are computed
  std::vector<std::string> overlays;  ///< files
  std::vector<std::string> labels;    ///< one a listed value or overlay; or none
};

struct StudyFile {
  std::string name;
  std::vector<std::string> scenarios;  ///< files, relative to the working directory
  std::uint64_t seed = 1;
  int replicates = 1;  ///< with a stopping rule its `max`
  bool until_settled = false;
  int samples = 0;  ///< of the latin hypercube; 0: no axis is latin
  std::optional<StoppingRule> stop;
  SourcePlace stop_place;  ///< of its metric
  std::vector<StudyAxis> axes;
};

/// The keys of a study file.
TomlKeys study_file_keys();
/// Throws InputError: unreadable file, TOML syntax, unknown key, wrong kind, out of bounds.
StudyFile read_study_file(const std::string& file);

}  // namespace lilytank
