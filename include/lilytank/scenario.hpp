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
  std::string path;        ///< dotted path: "forces.face_drag.K_F"
  std::string value;       ///< as TOML, in the key's unit
  std::string unit;        ///< SI, "%" or "1"; "" for text and switches
  std::string bounds;      ///< "0 .. 10", or the allowed words
  std::string meaning;     ///< one sentence from the table of keys
  bool is_default = true;  ///< whether neither a file nor --set set it
  SourcePlace where;       ///< file and line that set it; empty for defaults
};

/// What to write in a run, and how often.
struct OutputParameters {
  TrajectoryFormat trajectory = TrajectoryFormat::binary;  ///< file format of the stored poses
  double rate = 5;                                         ///< frames per second of simulated time
  double metrics_interval = 10;  ///< simulated time between rows of metrics.csv, s
};

/// Which copies of the target end a run.
enum class RunUntil : std::uint8_t {
  end,         ///< none: the run lasts its whole duration
  all_copies,  ///< all that the modules can form have been completed
};

/// A bound on what stands: "singles <= 2".
struct EndMetric {
  enum class Of : std::uint8_t { nothing, copies, most_copies, illegal, largest, size };
  Of of = Of::nothing;   ///< nothing: no bound
  int size = 0;          ///< of Of::size: number of assemblies of so many modules
  bool at_least = true;  ///< false: at most
  double bound = 0;
  /// Whether a value is beyond the bound, or at it.
  bool holds(double value) const { return at_least ? value >= bound : value <= bound; }
};

/// When a run ends before its duration: as soon as one of these conditions holds. Copies are of the
/// last target, where base station commands replace it.
struct EndParameters {
  RunUntil until = RunUntil::end;
  int copies = 0;           ///< number of completed copies that ends a run; 0: off
  double quiet_time = 0;    ///< time without an event that ends a run, s; 0: off
  std::string metric_text;  ///< the bound below as the user wrote it; empty: off
  EndMetric metric;
  /// Whether there is a condition at all.
  bool early() const {
    return until != RunUntil::end || copies > 0 || quiet_time > 0 || !metric_text.empty();
  }
};

/// A scenario with its model, ready to run.
struct Scenario {
  std::string title;       ///< name of the scenario, also of its output directory
  double duration = 600;   ///< simulated time of a run, s
  std::uint64_t seed = 1;  ///< key of all random numbers of a run
  EndParameters end;       ///< what ends a run earlier
  OutputParameters output;
  Model model;                         ///< built from the entries
  std::vector<ScenarioEntry> entries;  ///< every key, in the table's order
  /// The whole scenario as one TOML text with every value; input files it names (flow, rulesets,
  /// start poses) are to be found beside it under the names in `files`.
  std::string resolved;
  /// An input file by its name beside the resolved scenario.
  struct Attachment {
    std::string name, content;
  };
  std::vector<Attachment> files;  ///< input files that `resolved` names
  /// Hash of `resolved` and the attachments: equal for equal scenarios.
  std::uint64_t identity = 0;
};

/// Reads files (each may name a `base`), lays later ones over earlier ones, applies `sets`
/// ("path=value", value as TOML or "30 cm"), checks everything and builds the Model. Throws
/// InputError: unknown key, wrong type, out of bounds, wrong unit, missing file.
Scenario load_scenario(const std::vector<std::string>& files, const std::vector<std::string>& sets);

}  // namespace lilytank
