#include "io/scenario_resolve.hpp"

#include "io/scenario_text.hpp"
#include "io/scenario_values.hpp"
#include "text/fnv.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

/// The header and the last name of a path: "forces.damping" and "D_linear".
std::pair<std::string, std::string> parted(const std::string& path) {
  const auto dot = path.rfind('.');
  if (dot == std::string::npos) return {"", path};
  return {path.substr(0, dot), path.substr(dot + 1)};
}

std::string comment_of(const ScenarioKey& key) {
  std::string out = key.unit.empty() || key.unit == "1" ? "" : key.unit;
  const std::string bounds = bounds_text(key);
  if (!bounds.empty()) out += (out.empty() ? "" : ", ") + bounds;
  return out + (out.empty() ? "" : ": ") + key.meaning;
}

void add_command(const ScheduledCommand& scheduled, ScenarioText& out) {
  const Command& command = scheduled.command;
  const std::string modules =
      joined(command.modules, ", ", [](int module) { return std::to_string(module); });
  out.table("[command]");
  if (command.copies > 0) {
    out.line("copies", std::to_string(command.copies), "finished");
  } else {
    out.number("at", command.at, "s");
  }
  out.quoted("do", command_word(command.kind));
  out.line("modules", "[" + modules + "]", modules.empty() ? "all" : "");
  if (command.kind == CommandKind::pump_power) out.number("power", scheduled.power, "%");
  if (scheduled.file >= 0) {
    out.quoted("file", command_ruleset_name(static_cast<std::size_t>(scheduled.file)));
  }
}

}  // namespace

std::string command_ruleset_name(std::size_t index) {
  return "ruleset_" + std::to_string(index + 2) + ".rules";
}

std::vector<ScenarioEntry> entries_of(const std::vector<ScenarioKey>& keys,
                                      const std::map<std::string, SourcePlace>& places) {
  std::vector<ScenarioEntry> entries;
  for (const ScenarioKey& key : keys) {
    ScenarioEntry entry{key.path, value_text(key), key.unit, bounds_text(key), key.meaning, true,
                        {}};
    if (const auto set = places.find(key.path); set != places.end()) {
      entry.is_default = false;
      entry.where = set->second;
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::string resolved_text(const std::vector<ScenarioKey>& keys,
                          const std::vector<ScheduledCommand>& commands) {
  ScenarioText out;
  std::string header;
  for (const ScenarioKey& key : keys) {
    if (!key.neutral.empty() && value_text(key) == key.neutral) continue;
    const auto [table, name] = parted(key.path);
    if (table != header) out.table(table);
    header = table;
    out.line(name, value_text(key), comment_of(key));
  }
  for (const ScheduledCommand& command : commands) add_command(command, out);
  return kResolvedFirst + " Program version " LILYTANK_VERSION ".\n" + out.text() + kResolvedLast;
}

std::uint64_t identity_of(const Scenario& scenario) {
  Fnv hash;
  hash.add(scenario.resolved);
  for (const Scenario::Attachment& file : scenario.files)
    hash.add(file.name), hash.add(file.content);
  return hash.value();
}

}  // namespace lilytank
