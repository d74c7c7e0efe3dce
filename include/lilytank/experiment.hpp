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
  std::string file;          ///< path, relative to the working directory
  RecordingOptions options;  ///< format, units, checks and treatment of this recording
  SourcePlace place;         ///< where the experiment file names it
};

/// An experiment file with all that it names.
struct Experiment {
  std::string name;  ///< from [experiment], or the file's name
  Scenario base;     ///< what the scenario's keys set; base.model holds the tank and the bodies
  std::vector<RecordingSource> sources;  ///< all [[recording]] tables, read or not
  std::vector<Recording> recordings;  ///< the recordings that were read, in the order of `sources`
  std::vector<Finding> findings;      ///< findings of their checks, in the same order
};

/// Reads an experiment: files override each other as those of scenarios do (later wins; recordings
/// of a later file replace those of earlier ones, or come first if `experiment.further`), then
/// `sets` ("path=value"). Recordings are read for which `wanted` is true (all if it is empty).
/// Throws InputError.
Experiment load_experiment(const std::vector<std::string>& files,
                           const std::vector<std::string>& sets = {},
                           const std::function<bool(const RecordingSource&)>& wanted = {});

}  // namespace lilytank
