#include <algorithm>
#include <cmath>
#include <iostream>

#include "cli/inputs.hpp"
#include "cli/options.hpp"
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

void print_entries(const Scenario& scenario) {
  std::size_t path = 0, value = 0, bounds = 0;
  for (const ScenarioEntry& e : scenario.entries) {
    path = std::max(path, e.path.size());
    value = std::max(value, std::min<std::size_t>(32, with_unit(e).size()));
    bounds = std::max(bounds, std::min<std::size_t>(28, e.bounds.size()));
  }
  for (const ScenarioEntry& e : scenario.entries) {
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

int info_verb(const Arguments& arguments) {
  VerbOptions options("info", "SCENARIO...",
                      "Explains a scenario: every value, where it was set, and what follows.");
  std::vector<std::string> sets;
  options.add({"set", "a value, as tank.radius=0.3", "PATH=VALUE"}, &sets);
  if (!options.parse(arguments,
                     "which scenario? write lilytank info SCENARIO, as scenarios/chain5.toml")) {
    return Exit::done;
  }
  refuse_point_bodies(options.positional());
  const Scenario scenario = load_scenario(options.positional(), sets);
  print_entries(scenario);
  print_derived(scenario);
  return Exit::done;
}

}  // namespace lilytank::cli
