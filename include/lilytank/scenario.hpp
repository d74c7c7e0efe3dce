// A scenario is text: a TOML file, more files that overlay it (later wins), and --set path=value.
// Every number has a dotted path, a unit and bounds, all in one table (src/io/scenario_keys.cpp).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "lilytank/model.hpp"
#include "lilytank/trajectory.hpp"

namespace lilytank {

/// One value of a resolved scenario, for `lilytank info` and resolved.toml.
struct ScenarioEntry {
  std::string path;    ///< "forces.face_drag.K_F"
  std::string value;   ///< as TOML
  std::string unit;    ///< "" for text and switches
  std::string bounds;  ///< "0 .. 10", or the allowed words
  std::string meaning;
  bool is_default = true;
  SourcePlace where;  ///< where it was set
};

/// What to write in a run, and how often.
struct OutputParameters {
  TrajectoryFormat trajectory = TrajectoryFormat::binary;
  double rate = 5;               ///< frames per second of simulated time
  double metrics_interval = 10;  ///< s
};

struct Scenario {
  std::string title;
  double duration = 600;  ///< s
  std::uint64_t seed = 1;
  OutputParameters output;
  Model model;
  std::vector<ScenarioEntry> entries;
  /// The whole scenario as one TOML text with every value; input files it names (flow, rulesets,
  /// start poses) are to be found beside it under the names in `files`.
  std::string resolved;
  struct Attachment {
    std::string name, content;
  };
  std::vector<Attachment> files;
  /// Hash of `resolved` and the attachments: equal for equal scenarios.
  std::uint64_t identity = 0;
};

/// Reads files (each may name a `base`), lays later ones over earlier ones, applies `sets`
/// ("path=value", value as TOML or "30 cm"), checks everything and builds the Model. Throws
/// InputError: unknown key, wrong type, out of bounds, wrong unit, missing file.
Scenario load_scenario(const std::vector<std::string>& files, const std::vector<std::string>& sets);

}  // namespace lilytank
