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
  std::string file;  ///< path, from the working directory
  RecordingOptions options;
  SourcePlace place;  ///< where the experiment file names it
};

struct Experiment {
  std::string name;
  Scenario base;  ///< what the scenario's keys say; base.model holds the tank and the bodies
  std::vector<RecordingSource> sources;
  std::vector<Recording> recordings;  ///< of the sources that were wanted, in their order
  std::vector<Finding> findings;      ///< of these
};

/// Reads an experiment: files laid over each other as scenarios are (later wins; recordings of a
/// later file replace those of earlier ones), then `sets` ("path=value"). Recordings are read for
/// which `wanted` is true (all if it is empty). Throws InputError.
Experiment load_experiment(const std::vector<std::string>& files,
                           const std::vector<std::string>& sets = {},
                           const std::function<bool(const RecordingSource&)>& wanted = {});

}  // namespace lilytank
