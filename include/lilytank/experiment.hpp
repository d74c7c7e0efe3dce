// An experiment: the tank and bodies as a scenario, and what was recorded in it. A TOML file with
// every key that a scenario may have, [experiment] and [[recording]]; see docs/recordings.md.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "lilytank/recording_io.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {

/// A [[recording]] of an experiment file.
struct RecordingSource {
  /// Path, relative to the working directory.
  std::string file;
  /// Format, units, checks and treatment of this recording.
  RecordingOptions options;
  /// Where the experiment file names it.
  SourcePlace place;
};

/// An experiment file with all that it names.
struct Experiment {
  /// From [experiment], or the file's name.
  std::string name;
  /// What the scenario's keys set; base.model holds the tank and the bodies.
  Scenario base;
  /// All [[recording]] tables, read or not.
  std::vector<RecordingSource> sources;
  /// The recordings that were read, in the order of `sources`.
  std::vector<Recording> recordings;
  /// Findings of their checks, in the same order.
  std::vector<Finding> findings;
};

/// Reads an experiment: files laid over each other as scenarios are (later wins; recordings of a
/// later file replace those of earlier ones), then `sets` ("path=value"). Recordings are read for
/// which `wanted` is true (all if it is empty). Throws InputError.
Experiment load_experiment(const std::vector<std::string>& files,
                           const std::vector<std::string>& sets = {},
                           const std::function<bool(const RecordingSource&)>& wanted = {});

}  // namespace lilytank
