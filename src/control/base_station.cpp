#include "control/base_station.hpp"

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
      break;  // concerns the world, not a module
  }
}

void obey(Tick& tick, const Command& command) {
  Event event;
  event.step = tick.state.step;
  event.kind = EventKind::command;
  event.a = tick.state.next_command;
  tick.events.push_back(event);
  if (command.kind == CommandKind::replace_ruleset) tick.state.ruleset = command.ruleset;
  for (const int module : command.modules) tell(tick, command.kind, module);
  if (!command.modules.empty()) return;
  for (int module = 0; module < tick.model.module.count; ++module) tell(tick, command.kind, module);
}

}  // namespace

void obey_base_station(Tick& tick) {
  const auto count = static_cast<std::int32_t>(tick.model.commands.size());
  std::int32_t& next = tick.state.next_command;
  for (; next < count && due(tick.model.commands[next], tick.number); ++next)
    obey(tick, tick.model.commands[next]);
}

}  // namespace lilytank
