#include "control/base_station.hpp"

#include <algorithm>

#include "model/commands.hpp"

namespace lilytank {
namespace {

// A command is due in the first tick that does not begin before it; the allowance is for times
// such as 0.3 s, whose ratio to a tick is not a whole number of doubles.
bool due(const Command& command, std::int64_t tick) {
  return command.at / kTick <= static_cast<double>(tick) + 1e-6;
}

void tell(Tick& tick, CommandKind kind, int module) {
  Power& power = tick.state.firmware[module].power;
  switch (kind) {
    case CommandKind::pause:
      if (power == Power::on) power = Power::paused;
      break;
    case CommandKind::resume:
      if (power == Power::paused) power = Power::on;
      break;
    case CommandKind::switch_off:
      power = Power::off;
      break;
    case CommandKind::query:
      // A paused module answers by radio; one that is off does not.
      if (power == Power::off) break;
      report(tick, EventKind::report, {module, 0}, {});
      break;
    case CommandKind::replace_ruleset:
    case CommandKind::pump_power:
      break;  // concerns the world, not a module
  }
}

void announce(Tick& tick, int command) {
  Event event;
  event.step = tick.state.step;
  event.kind = EventKind::command;
  event.a = command;
  tick.events.push_back(event);
}

}  // namespace

BaseStation::BaseStation(const Model& model) : model_(&model) {
  for (const Command& command : model.feedback) {
    sets_ruleset_ = sets_ruleset_ || command.kind == CommandKind::replace_ruleset;
    sets_pumps_ = sets_pumps_ || command.kind == CommandKind::pump_power;
  }
  for (const Ruleset& rules : model.rulesets) final_labels_.push_back(final_labels(rules));
}

void BaseStation::speak(Tick& tick) const {
  const auto count = static_cast<std::int32_t>(model_->commands.size());
  std::int32_t& next = tick.state.next_command;
  for (; next < count && due(model_->commands[next], tick.number); ++next) obey(tick, next);
  if (sets_ruleset_ || sets_pumps_) follow_copies(tick);
}

void BaseStation::obey(Tick& tick, int index) const {
  const Command& command = model_->commands[index];
  announce(tick, index);
  if (command.kind == CommandKind::replace_ruleset) tick.state.ruleset = command.ruleset;
  if (command.kind == CommandKind::pump_power) tick.state.field = command.field;
  for (const int module : command.modules) tell(tick, command.kind, module);
  if (!command.modules.empty()) return;
  for (int module = 0; module < model_->module.count; ++module) tell(tick, command.kind, module);
}

int BaseStation::finished_copies(const State& state) const {
  if (final_labels_.empty()) return 0;
  const auto& joins = final_labels_[static_cast<std::size_t>(state.ruleset)];
  const auto label_of = [&](int i) { return state.firmware[static_cast<std::size_t>(i)].label; };
  return lilytank::finished_copies(joins, model_->module.count, label_of);
}

void BaseStation::follow_copies(Tick& tick) const {
  State& state = tick.state;
  const int copies = finished_copies(state);
  const auto choose = [&](CommandKind kind, int Command::*what, std::int32_t& now) {
    const int place = last_command(*model_, kind, state.next_command, copies);
    const int wanted = said_by(*model_, place, what);
    if (wanted == now) return;
    now = wanted;
    announce(tick, place);
  };
  if (sets_ruleset_) choose(CommandKind::replace_ruleset, &Command::ruleset, state.ruleset);
  if (sets_pumps_) choose(CommandKind::pump_power, &Command::field, state.field);
}

}  // namespace lilytank
