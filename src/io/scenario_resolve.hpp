// A scenario written out in full, and its identity.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "io/scenario_commands.hpp"
#include "io/scenario_keys.hpp"

namespace lilytank {

/// Names of input files beside resolved.toml.
inline const std::string kFlowName = "flow.csv";
inline const std::string kRulesetName = "ruleset.rules";
inline const std::string kPosesName = "poses.csv";
/// "ruleset_2.rules" for the first ruleset that a command names.
std::string command_ruleset_name(std::size_t index);

/// The first words and the last line of a resolved scenario. One without its last line was cut, and
/// would be completed with defaults.
inline const std::string kResolvedFirst =
    "# Every value of a lilytank scenario; a last line \"# end\" closes it.";
inline const std::string kResolvedLast = "\n# end\n";

/// One entry a key; `places` holds what was set, and where.
std::vector<ScenarioEntry> entries_of(const std::vector<ScenarioKey>& keys,
                                      const std::map<std::string, SourcePlace>& places);

/// Every key with its present value, unit and meaning, and the commands, as one TOML text.
std::string resolved_text(const std::vector<ScenarioKey>& keys,
                          const std::vector<ScheduledCommand>& commands);

/// FNV-1a (64 bits) over the resolved text and the attached files' names and contents.
std::uint64_t identity_of(const Scenario& scenario);

}  // namespace lilytank
