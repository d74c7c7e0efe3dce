#include "study/run_world.hpp"

#include <algorithm>
#include <cmath>

#include "jobs/report.hpp"
#include "lilytank/assembly_record.hpp"

namespace lilytank {
namespace {

constexpr std::int64_t kStepsPerLook = 64;  // between reports of simulated time

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
  const State& state = world.state();
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

bool over(EarlyEnd early, const World& world, const AssemblyRecord& record) {
  if (early == EarlyEnd::never || record.possible_copies() == 0) return false;
  const auto reached = static_cast<int>(record.completion_times().size());
  if (reached < record.possible_copies()) return false;
  if (awaits_another_target(world)) return false;
  return early == EarlyEnd::completed || is_final(world, record);
}

}  // namespace

bool is_final(const World& world, const AssemblyRecord& record) {
  if (record.copies() < record.possible_copies()) return false;
  const State& state = world.state();
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

WorldRun run_world(const Scenario& scenario, std::uint64_t seed, EarlyEnd early,
                   const JobControl& control, const std::function<void(double)>& simulated) {
  control.check_stop();
  WorldRun out;
  RunRow& row = out.row;
  row.seed = seed;
  World world(scenario.model, seed);
  AssemblyRecord record(scenario.model);
  record.observe(world);
  const double dt = scenario.model.dt;
  const auto steps = static_cast<std::int64_t>(std::floor(scenario.duration / dt + 0.5));
  double reported = 0;
  const auto report = [&] {
    if (simulated) simulated(world.time() - reported);
    reported = world.time();
  };
  bool left = false;
  while (world.state().step < steps && row.status == RunStatus::ok && !left) {
    control.check_stop();
    row.status = world.step();
    record.observe(world);
    // Looked at where something happened: what stands changes with events only.
    left = !world.events().empty() && over(early, world, record);
    if (world.state().step % kStepsPerLook == 0) report();
  }
  report();
  out.simulated = world.time();
  row.duration = left ? static_cast<double>(steps) * dt : world.time();
  row.possible = record.possible_copies();
  row.copies = record.copies();
  row.illegal = record.illegal();
  row.completion = record.completion_times();
  if (row.status == RunStatus::diverged) {
    row.note = divergence_text(world.divergence(), scenario.model);
  }
  return out;
}

WorldRun run_world(const Study& study, int setting, int replicate, const JobControl& control,
                   const std::function<void(double)>& simulated) {
  control.check_stop();
  const StudyPlan& plan = study.plan();
  WorldRun out =
      run_world(study.scenario(setting), plan.seed_of(replicate),
                plan.until_settled ? EarlyEnd::settled : EarlyEnd::never, control, simulated);
  out.row.setting = setting, out.row.replicate = replicate;
  out.row.id = plan.id_of(setting, replicate);
  out.row.values = plan.settings[static_cast<std::size_t>(setting)].values;
  return out;
}

}  // namespace lilytank
