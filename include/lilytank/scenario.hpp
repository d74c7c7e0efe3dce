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
  /// Dotted path: "forces.face_drag.K_F".
  std::string path;
  /// As TOML, in the key's unit.
  std::string value;
  /// SI, "%" or "1"; "" for text and switches.
  std::string unit;
  /// "0 .. 10", or the allowed words.
  std::string bounds;
  /// One sentence from the table of keys.
  std::string meaning;
  /// Whether neither a file nor --set set it.
  bool is_default = true;
  /// File and line that set it; empty for defaults.
  SourcePlace where;
};

/// What to write in a run, and how often.
struct OutputParameters {
  /// File format of the stored poses.
  TrajectoryFormat trajectory = TrajectoryFormat::binary;
  /// Frames per second of simulated time.
  double rate = 5;
  /// Simulated time between rows of metrics.csv, s.
  double metrics_interval = 10;
};

/// A scenario with its model, ready to run.
struct Scenario {
  /// Name of the scenario, also of its output directory.
  std::string title;
  /// Simulated time of a run, s.
  double duration = 600;
  /// Key of all random numbers of a run.
  std::uint64_t seed = 1;
  OutputParameters output;
  /// Built from the entries.
  Model model;
  /// Every key, in the table's order.
  std::vector<ScenarioEntry> entries;
  /// The whole scenario as one TOML text with every value; input files it names (flow, rulesets,
  /// start poses) are to be found beside it under the names in `files`.
  std::string resolved;
  /// An input file by its name beside the resolved scenario.
  struct Attachment {
    std::string name, content;
  };
  /// Input files that `resolved` names.
  std::vector<Attachment> files;
  /// Hash of `resolved` and the attachments: equal for equal scenarios.
  std::uint64_t identity = 0;
};

/// Reads files (each may name a `base`), lays later ones over earlier ones, applies `sets`
/// ("path=value", value as TOML or "30 cm"), checks everything and builds the Model. Throws
/// InputError: unknown key, wrong type, out of bounds, wrong unit, missing file.
Scenario load_scenario(const std::vector<std::string>& files, const std::vector<std::string>& sets);

}  // namespace lilytank
