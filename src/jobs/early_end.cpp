#include "jobs/early_end.hpp"

#include <algorithm>
#include <cmath>

#include "text/number.hpp"

namespace lilytank {
namespace {

Label shown(const State& state, int module, int face) {
  const Firmware& firmware = state.firmware[module];
  return {firmware.label, hop_of(firmware.last, face)};
}

bool is(const Rule& rule, const Label& a, const Label& b) {
  return (rule.before[0] == a && rule.before[1] == b) ||
         (rule.before[0] == b && rule.before[1] == a);
}

// Whether some rule can act on this face of a module of a copy, whoever may meet it there.
bool can_change(const Ruleset& rules, const State& state, int module, int face) {
  const Face& own = state.faces[4 * module + face];
  const bool bonded = own.status == FaceStatus::bonded;
  const Label label = shown(state, module, face);
  for (const Rule& rule : rules.rules) {
    if (rule.p <= 0 || (rule.kind == RuleKind::link) == bonded) continue;
    const bool acts = bonded ? is(rule, label, shown(state, own.partner, own.partner_face))
                             : rule.before[0] == label || rule.before[1] == label;
    if (acts) return true;
  }
  return false;
}

// Whether a ruleset with another target is still to come: then copies are counted anew.
bool awaits_another_target(const World& world) {
  const Model& model = world.model();
  const State& state = world.firmware();
  const auto other = [&](const Command& command) {
    const auto target = [&](int ruleset) {
      return canonical_shape(model.rulesets[static_cast<std::size_t>(ruleset)].target);
    };
    return command.kind == CommandKind::replace_ruleset &&
           target(command.ruleset) != target(state.ruleset);
  };
  const auto& timed = model.commands;
  return std::any_of(timed.begin() + state.next_command, timed.end(), other) ||
         std::any_of(model.feedback.begin(), model.feedback.end(), other);
}

std::int64_t steps_in(double time, const Scenario& scenario) {
  return static_cast<std::int64_t>(std::floor(time / scenario.model.dt + 0.5));
}

/// Copies at which a run ends; 0: it does not end by copies.
int copies_at_end(const EndParameters& end, const AssemblyRecord& record) {
  if (end.copies > 0) return end.copies;
  return end.until == RunUntil::all_copies ? record.possible_copies() : 0;
}

double value_of(const EndMetric& metric, const AssemblyRecord& record) {
  const std::vector<int>& sizes = record.by_size();
  switch (metric.of) {
    case EndMetric::Of::copies:
      return record.copies();
    case EndMetric::Of::most_copies:
      return record.most_copies();
    case EndMetric::Of::illegal:
      return static_cast<double>(record.illegal());
    case EndMetric::Of::size:
      return sizes[static_cast<std::size_t>(metric.size)];
    default:
      break;
  }
  for (std::size_t n = sizes.size(); n-- > 1;) {
    if (sizes[n] > 0) return static_cast<double>(n);
  }
  return 0;
}

bool reached(const EndMetric& metric, const AssemblyRecord& record) {
  return metric.of != EndMetric::Of::nothing && metric.holds(value_of(metric, record));
}

bool completed(int copies, const World& world, const AssemblyRecord& record) {
  if (copies == 0 || static_cast<int>(record.completion_times().size()) < copies) return false;
  return !awaits_another_target(world);
}

}  // namespace

bool is_final(const World& world, const AssemblyRecord& record) {
  if (record.copies() < record.possible_copies()) return false;
  const State& state = world.firmware();
  for (int module = 0; module < world.model().module.count; ++module) {
    if (record.complete()[static_cast<std::size_t>(module)] == 0) continue;
    for (const Ruleset& rules : world.model().rulesets) {
      for (int face = 0; face < 4; ++face) {
        if (can_change(rules, state, module, face)) return false;
      }
    }
  }
  return true;
}

bool over(EarlyEnd early, const World& world, const AssemblyRecord& record) {
  if (early == EarlyEnd::never || !completed(record.possible_copies(), world, record)) return false;
  return early == EarlyEnd::completed || is_final(world, record);
}

std::int64_t planned_steps(const Scenario& scenario) {
  return steps_in(scenario.duration, scenario);
}

bool over(const Scenario& scenario, const World& world, const AssemblyRecord& record,
          std::int64_t last_event) {
  const EndParameters& end = scenario.end;
  if (!world.events().empty())
    return completed(copies_at_end(end, record), world, record) || reached(end.metric, record);
  if (!(end.quiet_time > 0)) return false;
  const std::int64_t quiet = std::max<std::int64_t>(1, steps_in(end.quiet_time, scenario));
  return world.steps() - last_event >= quiet;
}

void refuse_early_end(const Scenario& scenario, const std::string& instead) {
  if (!scenario.end.early()) return;
  for (const ScenarioEntry& entry : scenario.entries) {
    const bool condition = entry.path == "run.until" || entry.path == "run.until_copies" ||
                           entry.path == "run.quiet_time" || entry.path == "run.until_metric";
    if (!condition || entry.is_default) continue;
    throw InputError(entry.where, entry.path + " ends single runs only; " + instead);
  }
}

std::string end_text(const Scenario& scenario, const World& world, const AssemblyRecord& record) {
  const std::string at = " at " + without_rounding(world.time()) + " s";
  const int copies = copies_at_end(scenario.end, record);
  if (completed(copies, world, record)) {
    return std::to_string(copies) + " of " + std::to_string(record.possible_copies()) +
           " copies completed" + at;
  }
  if (reached(scenario.end.metric, record)) return scenario.end.metric_text + at;
  if (world.steps() < planned_steps(scenario)) {
    return "no event for " + shortest(scenario.end.quiet_time) + " s" + at;
  }
  return "run.duration reached" + at;
}

}  // namespace lilytank
