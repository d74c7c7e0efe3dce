// The base station's commands: [[command]] tables.
#pragma once
#include <string>
#include <vector>

#include "io/scenario_layers.hpp"
#include "io/toml_key.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {

/// A ruleset's text and where it came from.
struct RulesetFile {
  std::string file, content;
};

/// A command and, for do = "ruleset", the place of its file among RulesetFiles (from 0).
struct ScheduledCommand {
  Command command;
  int file = -1;
  double power = 0;  ///< %, for do = "pump_power"
};

/// The keys of a command.
TomlKeys command_keys();
/// Reads the tables, sorted by time, equal times in the file's order; after them those that go with
/// finished copies, by their number. Files named by do =
/// "ruleset" are added to `files`, each once. Throws InputError.
std::vector<ScheduledCommand> read_commands(const std::vector<CommandTable>& tables, int modules,
                                            std::vector<RulesetFile>& files);

/// The word for `do`: "pause".
std::string command_word(CommandKind kind);

}  // namespace lilytank
