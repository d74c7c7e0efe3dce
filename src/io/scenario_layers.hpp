// Scenario files as lists of assignments, in the order in which they override each other.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

/// A TOML value that has no place in a scenario, named for messages: "a date", "a mixed list".
struct Unusable {
  std::string kind;
};
/// A table without keys; its path is still to be checked.
struct EmptyTable {};
using Numbers = std::vector<std::int64_t>;
/// A list of numbers that are not all whole.
using Reals = std::vector<double>;
using TomlValue =
    std::variant<bool, std::int64_t, double, std::string, Numbers, Unusable, EmptyTable, Reals>;

/// "a number", "text", ... for messages.
std::string kind_of(const TomlValue& value);

/// One `path = value`, and where it stands.
struct Assignment {
  std::vector<std::string> keys;        ///< the path's parts
  std::vector<SourcePlace> key_places;  ///< of each part
  TomlValue value;
  SourcePlace place;      ///< of the value
  std::string directory;  ///< files that the value names are relative to this
  std::string raw;        ///< the value as given to --set
  std::string path() const;
};

/// A [[command]] or [[recording]] table.
struct CommandTable {
  SourcePlace place;
  std::vector<Assignment> fields;
};

/// The assignments of one file, or of all --set together. A layer with commands or recordings
/// replaces those below it.
struct Layer {
  std::vector<Assignment> values;
  std::vector<CommandTable> commands;
  bool has_commands = false;
  /// What makes a scenario an experiment; whoever simulates it passes over them.
  std::vector<Assignment> experiment;  ///< of [experiment], without its name in the paths
  std::vector<CommandTable> recordings;
  bool has_recordings = false;
};

/// Reads "path=value" texts given to a command line's `option` ("--set"); a value is TOML, or else
/// text. Throws InputError.
std::vector<Assignment> read_assignments(const std::vector<std::string>& texts,
                                         const std::string& option);

/// Reads the files, each after the files named by its `base`, and then the sets. Throws InputError:
/// unreadable file, TOML syntax, circle of bases.
std::vector<Layer> read_layers(const std::vector<std::string>& files,
                               const std::vector<std::string>& sets);

/// Takes run.seed out of the texts given to --set: studies and searches derive the seeds of their
/// runs from it. Throws InputError.
std::optional<std::uint64_t> take_seed(std::vector<std::string>& sets);

struct Scenario;
/// What load_scenario() does once everything is read. Throws InputError.
Scenario build_scenario(std::vector<Layer> layers);

}  // namespace lilytank
