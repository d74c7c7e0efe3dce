#include "view/pumps.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include "model/commands.hpp"
#include "text/number.hpp"
#include "view/streamlines.hpp"

namespace lilytank {
namespace {

// What the base station of src/control knew at a frame, from the stored events.
class Follower {
 public:
  explicit Follower(const StoredRun& run) : run_(run), model_(run.scenario.model) {
    for (const Ruleset& rules : model_.rulesets) joins_.push_back(final_labels(rules));
  }

  // The flow in force from frame `f` on; frames must come in order.
  int field_at_frame(int f) {
    const double time = run_.trajectory.time[static_cast<std::size_t>(f)];
    const auto& commands = model_.commands;  // in order of time
    const auto given = static_cast<int>(std::count_if(
        commands.begin(), commands.end(), [&](const Command& c) { return c.at <= time; }));
    const int copies = copies_at(f);
    const auto holds = [&](CommandKind kind, int Command::*what) {
      return said_by(model_, last_command(model_, kind, given, copies), what);
    };
    const int rules = holds(CommandKind::replace_ruleset, &Command::ruleset);
    const int field = holds(CommandKind::pump_power, &Command::field);
    ruleset_ = static_cast<std::size_t>(rules);
    return field;
  }

 private:
  int copies_at(int f) const {
    const Trajectory& t = run_.trajectory;
    if (t.markings.empty() || ruleset_ >= joins_.size()) return 0;
    const std::size_t first = static_cast<std::size_t>(f) * (t.markings.size() / t.time.size());
    return finished_copies(joins_[ruleset_], t.modules, [&](int i) {
      return t.markings[first + static_cast<std::size_t>(i)].label;
    });
  }

  const StoredRun& run_;
  const Model& model_;
  std::vector<std::vector<std::array<int, 2>>> joins_;  // the last joins, by ruleset
  std::size_t ruleset_ = 0;
};

bool by_copies(const Model& model) {
  return std::any_of(model.feedback.begin(), model.feedback.end(),
                     [](const Command& c) { return c.kind == CommandKind::pump_power; });
}

// Powers by number of the flow. A Model knows flows only; the commands of the resolved text know
// the powers, and give each new one the next number.
std::vector<std::string> powers_of(const Scenario& scenario) {
  std::vector<std::string> powers;
  for (const ScenarioEntry& entry : scenario.entries) {
    if (entry.path == "flow.pump_power") powers.push_back(entry.value);
  }
  if (powers.empty()) return {};
  std::istringstream lines(scenario.resolved);
  bool commands = false;
  for (std::string line; std::getline(lines, line);) {
    commands = commands || line == "[[command]]";
    constexpr std::string_view kKey = "power = ";
    if (!commands || !line.starts_with(kKey)) continue;
    const std::string value(trimmed(line.substr(kKey.size(), line.find('#') - kKey.size())));
    const auto same = [&](const std::string& p) { return parse_number(p) == parse_number(value); };
    if (std::none_of(powers.begin(), powers.end(), same)) powers.push_back(value);
  }
  if (powers.size() != 1 + scenario.model.other_fields.size()) powers.clear();
  return powers;
}

}  // namespace

const FlowField* field_of(const Model& model, int number) {
  if (number <= 0) return model.field.get();
  const auto i = static_cast<std::size_t>(number - 1);
  return i < model.other_fields.size() ? model.other_fields[i].get() : nullptr;
}

double peak_of_all(const Model& model) {
  double peak = 0;
  for (int i = 0; i <= static_cast<int>(model.other_fields.size()); ++i) {
    const FlowField* field = field_of(model, i);
    if (field) peak = std::max(peak, peak_speed(*field, model.tank.radius));
  }
  return peak;
}

Pumps::Pumps(const StoredRun& run) : powers_(powers_of(run.scenario)) {
  const Model& model = run.scenario.model;
  changes_.push_back({-1, 0});
  if (model.other_fields.empty()) return;
  const auto add = [&](double time, int field) {
    if (field != changes_.back().field) changes_.push_back({time, field});
  };
  if (by_copies(model)) {
    Follower station(run);
    for (int f = 0; f < run.trajectory.frames(); ++f) {
      add(run.trajectory.time[static_cast<std::size_t>(f)], station.field_at_frame(f));
    }
  } else {
    for (const Command& c : model.commands) {
      if (c.kind == CommandKind::pump_power) add(c.at, c.field);
    }
  }
}

int Pumps::field_at(double time) const {
  const auto after = std::upper_bound(changes_.begin(), changes_.end(), time,
                                      [](double t, const Since& s) { return t < s.time; });
  return after == changes_.begin() ? 0 : std::prev(after)->field;
}

std::string Pumps::power_of(int field) const {
  const auto i = static_cast<std::size_t>(field);
  return powers_.size() > 1 && i < powers_.size() ? powers_[i] + " %" : "";
}

}  // namespace lilytank
