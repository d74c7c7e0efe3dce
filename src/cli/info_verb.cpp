#include <algorithm>
#include <cmath>
#include <iostream>

#include "cli/inputs.hpp"
#include "cli/options.hpp"
#include "io/json.hpp"
#include "io/scenario_commands.hpp"
#include "lilytank/assembly_record.hpp"
#include "lilytank/run.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

std::string with_unit(const ScenarioEntry& entry) {
  return entry.unit.empty() || entry.unit == "1" ? entry.value : entry.value + " " + entry.unit;
}

Json entries_json(const std::vector<ScenarioEntry>& entries) {
  Json out = Json::array();
  for (const ScenarioEntry& e : entries) {
    out.push_back({{"path", e.path},
                   {"value", e.value},
                   {"unit", e.unit},
                   {"bounds", e.bounds},
                   {"default", e.is_default},
                   {"where", e.is_default ? "" : e.where.text()},
                   {"meaning", e.meaning}});
  }
  return out;
}

Json scenario_json(const Scenario& scenario, const std::vector<ScenarioEntry>& entries) {
  const Model& m = scenario.model;
  Json forces = Json::array();
  for (const ActiveForce& force : m.forces) forces.push_back(force.term->name());
  return {{"schema", "info/1"},
          {"title", scenario.title},
          {"scenario", hex(scenario.identity)},
          {"modules", m.module.count},
          {"balls", m.ball.count},
          {"duration_s", scenario.duration},
          {"step_s", m.dt},
          {"forces", std::move(forces)},
          {"values", entries_json(entries)}};
}

/// A value in TOML, or a number with its unit, in columns.
void print_entries(const std::vector<ScenarioEntry>& entries) {
  std::size_t path = 0, value = 0, bounds = 0;
  for (const ScenarioEntry& e : entries) {
    path = std::max(path, e.path.size());
    value = std::max(value, std::min<std::size_t>(32, with_unit(e).size()));
    bounds = std::max(bounds, std::min<std::size_t>(28, e.bounds.size()));
  }
  for (const ScenarioEntry& e : entries) {
    std::cout << padded(e.path, path) << "  " << padded(with_unit(e), value) << "  "
              << padded(e.bounds, bounds) << "  "
              << (e.is_default ? "default" : "set at " + e.where.text()) << " - " << e.meaning
              << "\n";
  }
}

void print_derived(const Scenario& scenario) {
  const Model& m = scenario.model;
  std::cout << "\nbodies           " << m.bodies() << " (" << m.module.count << " modules, "
            << m.ball.count << " balls)\nsteps            "
            << static_cast<std::int64_t>(std::floor(scenario.duration / m.dt + 0.5)) << " of "
            << shortest(m.dt) << " s\nforces          ";
  for (const ActiveForce& force : m.forces) std::cout << " " << force.term->name();
  std::cout << "\nscenario         " << hex(scenario.identity) << "\n";
  for (const Command& command : m.commands) {
    std::cout << "at " << shortest(command.at) << " s: " << command_word(command.kind) << ", "
              << (command.modules.empty() ? "all" : std::to_string(command.modules.size()))
              << " modules\n";
  }
  for (const Command& command : m.feedback) {
    std::cout << "with " << command.copies
              << " finished copies or more: " << command_word(command.kind) << "\n";
  }
  for (const Ruleset& rules : m.rulesets) {
    if (!rules.target.empty()) {
      std::cout << "possible copies  " << m.module.count / static_cast<int>(rules.target.size())
                << " of " << rules.target.size() << " modules\n";
    }
    std::cout << "\n" << to_text(rules);
  }
}

}  // namespace

int info_verb(const Arguments& arguments, const Host&) {
  VerbOptions options("info", "SCENARIO...",
                      "Explains a scenario: every value, where it was set, and what follows.");
  std::vector<std::string> sets;
  std::string only;
  bool changed = false, json = false;
  options.add({"set", "a value, as tank.radius=0.3", "PATH=VALUE"}, &sets);
  options.add({"only", "values whose paths begin so, as forces.face_drag", "PREFIX"}, &only);
  options.add({"changed", "values that are not the defaults"}, &changed);
  options.add({"json", "print JSON"}, &json);
  if (!options.parse(arguments,
                     "which scenario? write lilytank info SCENARIO, as scenarios/chain5.toml")) {
    return Exit::done;
  }
  refuse_point_bodies(options.positional());
  const Scenario scenario = load_scenario(options.positional(), sets);
  std::vector<ScenarioEntry> shown = scenario.entries;
  std::erase_if(shown, [&](const ScenarioEntry& e) {
    return !e.path.starts_with(only) || (changed && e.is_default);
  });
  if (shown.empty() && !changed) {
    options.refuse("no value's path begins with '" + only + "'");
  }
  if (json) {
    std::cout << json_text(scenario_json(scenario, shown));
    return Exit::done;
  }
  print_entries(shown);
  if (only.empty()) print_derived(scenario);
  return Exit::done;
}

}  // namespace lilytank::cli
