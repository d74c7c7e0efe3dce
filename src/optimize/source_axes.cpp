// The axes of a search's space, and what a point on them says.
#include <algorithm>
#include <cmath>

#include "optimize/assignments.hpp"
#include "optimize/source.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// '*' in `pattern` stands for any letters.
bool fits(std::string_view pattern, std::string_view name) {
  const auto star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == name;
  if (!name.starts_with(pattern.substr(0, star))) return false;
  const std::string_view rest = pattern.substr(star + 1);
  for (std::size_t at = star; at <= name.size(); ++at) {
    if (fits(rest, name.substr(at))) return true;
  }
  return false;
}

Assignment valued(Assignment path, TomlValue value) {
  path.value = std::move(value);
  return path;
}

std::optional<double> value_of(const Scenario& scenario, const Assignment& path) {
  for (const Rule& rule : scenario.model.rulesets.front().rules) {
    if (is_rule(path) && rule.name == path.keys[1]) return rule.p;
  }
  for (const ScenarioEntry& entry : scenario.entries) {
    if (entry.path == path.path()) return parse_number(entry.value);
  }
  return std::nullopt;
}

}  // namespace

// One axis a parameter, or one for each rule that its pattern fits.
void Optimization::Source::add_parameter(const OptimizeParameter& parameter, const Scenario& base) {
  std::vector<Assignment> paths;
  if (!is_rule(parameter.path)) {
    paths.push_back(parameter.path);
  } else {
    const std::string& wanted = parameter.path.keys[1];
    const bool star = wanted.find('*') != std::string::npos;
    for (const Rule& rule : base.model.rulesets.front().rules) {
      const bool undoes = rule.kind == RuleKind::unlink && rule.p > 0;
      if (star ? !undoes || !fits(wanted, rule.name) : wanted != rule.name) continue;
      paths.push_back(parameter.path);
      paths.back().keys[1] = rule.name;
    }
    if (paths.empty() && (star || ruleset)) {
      throw InputError(parameter.path.place,
                       "'" + parameter.path.path() + "' fits no rule" +
                           (ruleset ? " of '" + ruleset->name + "', a ruleset of the race," : "") +
                           (star ? " that can undo a bond (p > 0)" : ""));
    }
    // A rule that is not there is refused, with the nearest name, where the scenario is built.
    if (paths.empty()) paths.push_back(parameter.path);
  }
  for (const Assignment& path : paths) {
    const auto now = value_of(base, path);
    SearchAxis axis{path.path(), parameter.low, parameter.high, parameter.logarithmic};
    add_axis(std::move(axis), {Use::parameter, path, parameter.whole, 0},
             parameter.start.value_or(now.value_or(parameter.low)));
  }
}

void Optimization::Source::add_axis(SearchAxis axis, Axis use, double start) {
  plan.start.push_back(std::clamp(start, axis.low, axis.high));
  plan.space.push_back(std::move(axis));
  axes_.push_back(std::move(use));
}

void Optimization::Source::add_second_set() {
  const std::size_t first = axes_.size();
  for (std::size_t i = 0; i < first; ++i) {
    if (!is_rule(axes_[i].path)) continue;
    SearchAxis axis = plan.space[i];
    axis.name = "after." + axis.name;
    add_axis(std::move(axis), {Use::after_p, axes_[i].path, false, 0}, plan.start[i]);
  }
  if (axes_.size() == first) {
    throw InputError(
        file.hybrid_place,
        "a hybrid strategy has two sets of probabilities, and no [[parameter]] is one");
  }
  if (plan.possible < 2) {
    throw InputError(file.hybrid_place,
                     "a hybrid strategy changes with a finished copy, and only one is possible");
  }
  if (plan.possible == 2) return;  // it can only change with the first
  add_axis({"after.copies", 1, static_cast<double>(plan.possible), false},
           {Use::after_copies, {}, false, 0}, 0.5 * (1 + plan.possible));
}

void Optimization::Source::add_agitation(const Scenario& base) {
  const AgitationTable& table = file.agitation;
  const double power = value_of(base, named({"flow", "pump_power"}, 0.0)).value_or(0);
  for (const SearchAxis& axis : plan.space) {
    if (axis.name == "flow.pump_power") {
      throw InputError(table.place, "flow.pump_power is searched already, by a [[parameter]]");
    }
  }
  const bool schedule = table.kind == Agitation::schedule;
  const int pieces = schedule ? table.pieces : plan.possible;
  for (int i = 0; i < pieces; ++i) {
    add_axis({"power." + std::to_string(i), table.low, table.high, false},
             {Use::power, {}, true, static_cast<std::size_t>(i)}, power);
  }
  for (int i = 1; schedule && i < pieces; ++i) {
    add_axis({"change." + std::to_string(i), 0, plan.horizon, false},
             {Use::change, {}, false, static_cast<std::size_t>(i)}, plan.horizon * i / pieces);
  }
}

Optimization::Source::DecodedPoint Optimization::Source::decoded(
    const std::vector<double>& point) const {
  DecodedPoint out;
  if (file.hybrid) out.after_copies = 1;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Axis& axis = axes_[i];
    const double value = axis.whole ? std::floor(point[i] + 0.5) : point[i];
    switch (axis.use) {
      case Use::parameter:
        out.values.push_back(axis.whole ? valued(axis.path, static_cast<std::int64_t>(value))
                                        : valued(axis.path, value));
        break;
      case Use::after_p:
        out.after.emplace_back(axis.path.keys[1], value);
        break;
      case Use::after_copies:
        out.after_copies = std::min(static_cast<int>(value), plan.possible - 1);
        break;
      case Use::power:
        out.powers.push_back(value);
        break;
      case Use::change:
        out.changes.push_back(value);
        break;
    }
  }
  std::sort(out.changes.begin(), out.changes.end());
  return out;
}

Layer Optimization::Source::layer(const DecodedPoint& point) const {
  Layer out;
  out.values = point.values;
  if (point.powers.empty()) return out;
  out.values.push_back(named({"flow", "pump_power"}, point.powers.front()));
  out.has_commands = true;
  for (std::size_t i = 1; i < point.powers.size(); ++i) {
    CommandTable command;
    command.place = file.agitation.place;
    if (plan.agitation == Agitation::feedback) {
      command.fields.push_back(named({"copies"}, static_cast<std::int64_t>(i)));
    } else {
      command.fields.push_back(named({"at"}, point.changes[i - 1]));
    }
    command.fields.push_back(named({"do"}, std::string("pump_power")));
    command.fields.push_back(named({"power"}, point.powers[i]));
    out.commands.push_back(std::move(command));
  }
  return out;
}

Ruleset Optimization::Source::second_set(const DecodedPoint& point, const Ruleset& first) const {
  Ruleset out = first;
  for (const auto& [name, p] : point.after) {
    for (Rule& rule : out.rules) {
      if (rule.name == name) rule.p = p, rule.where = file.hybrid_place;
    }
  }
  check_probabilities(out);
  return out;
}

}  // namespace lilytank
