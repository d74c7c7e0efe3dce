// From files and --set to a Scenario: read, overlay, check, build the Model.
#include "lilytank/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "io/atomic_file.hpp"
#include "io/end_metric.hpp"
#include "io/poses_csv.hpp"
#include "io/scenario_commands.hpp"
#include "io/scenario_keys.hpp"
#include "io/scenario_layers.hpp"
#include "io/scenario_resolve.hpp"
#include "io/scenario_values.hpp"
#include "lilytank/start.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

bool is_rule(const Assignment& a) {
  return a.keys.front() == "rules";
}

class Loader {
 public:
  explicit Loader(std::vector<Layer> layers) : layers_(std::move(layers)) {}

  Scenario load() {
    keys_ = scenario_keys(draft_);
    assign_all(false);
    read_rules();
    assign_all(true);
    check();
    build_forces();
    build_field();
    build_start();
    build_commands();
    check_end();
    return finish();
  }

 private:
  SourcePlace place(const std::string& path) const {
    const auto found = places_.find(path);
    return found == places_.end() ? SourcePlace{path, 0, 0} : found->second;
  }
  bool was_set(const std::string& path) const { return places_.count(path) != 0; }

  // Rules are named by a file that the first pass finds; a second pass sets their probabilities.
  void assign_all(bool rules) {
    for (const Layer& layer : layers_) {
      for (const Assignment& value : layer.values) {
        if (is_rule(value) == rules) assign_one(value);
      }
      if (!rules) imply(layer);
    }
  }

  void assign_one(const Assignment& value) {
    const std::string path = value.path();
    const auto at = [&](const ScenarioKey& key) { return key.path == path; };
    const auto found = std::find_if(keys_.begin(), keys_.end(), at);
    if (found == keys_.end()) {
      const bool table = std::any_of(keys_.begin(), keys_.end(), [&](const ScenarioKey& key) {
        return key.path.starts_with(path + ".");
      });
      if (table && std::holds_alternative<EmptyTable>(value.value)) return;
      if (is_rule(value) && draft_.ruleset_file.empty()) {
        throw InputError(value.key_places.front(),
                         "'" + path + "' names a rule, but no ruleset.file is set");
      }
      throw unknown_key(value, keys_);
    }
    assign(*found, value);
    places_[path] = value.place;
  }

  // What a layer implies: naming a file chooses it, naming a parameter of a force that
  // is not in the baseline switches it on.
  void imply(const Layer& layer) {
    std::map<std::string, SourcePlace> here;
    for (const Assignment& value : layer.values) here[value.path()] = value.place;
    const auto named = [&](const std::string& path) { return here.count(path) != 0; };
    if (named("flow.file") && !named("flow.source")) {
      draft_.source = draft_.flow_file.empty() ? FlowSource::tank : FlowSource::file;
      places_["flow.source"] = here["flow.file"];
    }
    if (named("start.file") && !named("start.layout")) {
      Layout& layout = draft_.scenario.model.start.layout;
      layout = draft_.start_file.empty() ? Layout::random : Layout::poses;
      places_["start.layout"] = here["start.file"];
    }
    for (ForceDraft& force : draft_.forces) {
      const std::string base = "forces." + std::string(force.term->name()) + ".";
      const auto first = here.lower_bound(base);
      const bool any = first != here.end() && first->first.starts_with(base);
      if (force.term->baseline() || !any || named(base + "on")) continue;
      force.on = true;
      places_[base + "on"] = first->second;
    }
  }

  void read_rules() {
    if (!draft_.ruleset_file.empty()) {
      rules_text_ = read_whole(draft_.ruleset_file, place("ruleset.file"));
      draft_.rules = parse_ruleset(rules_text_, draft_.ruleset_file);
    }
    // Beside the ruleset's file, so that resolved.toml reads in a natural order.
    const auto after = std::find_if(keys_.begin(), keys_.end(), [](const ScenarioKey& key) {
      return key.path == "start.layout";
    });
    const std::vector<ScenarioKey> rules = rule_keys(draft_);
    keys_.insert(after, rules.begin(), rules.end());
  }

  void check() {
    Scenario& s = draft_.scenario;
    Model& m = s.model;
    const double parts = std::floor(kTick / m.dt + 0.5);
    if (std::fabs(m.dt * parts - kTick) > 1e-12) {
      throw InputError(place("run.dt"), "run.dt = " + shortest(m.dt) +
                                            " s is not 25 ms divided by a whole number - the "
                                            "nearest is " +
                                            shortest(kTick / parts) + " s, 25 ms / " +
                                            std::to_string(static_cast<int>(parts)));
    }
    m.steps_per_tick = static_cast<int>(parts), m.dt = kTick / parts;
    draft_.tank.radius = m.tank.radius;
    if (m.bodies() == 0) {
      throw InputError(place(was_set("module.count") ? "module.count" : "ball.count"),
                       "there is nothing to simulate: module.count and ball.count are both 0");
    }
    if (m.start.radius > m.tank.radius) {
      throw InputError(place(was_set("start.radius") ? "start.radius" : "tank.radius"),
                       "start.radius = " + shortest(m.start.radius) +
                           " m is beyond tank.radius = " + shortest(m.tank.radius) + " m");
    }
    const double widest =
        std::max(m.module.count > 0 ? m.module.side : 0, m.ball.count > 0 ? 2 * m.ball.radius : 0);
    if (m.start.layout == Layout::lattice && m.start.distance < widest) {
      throw InputError(place("start.distance"), "start.distance = " + shortest(m.start.distance) +
                                                    " m: bodies of " + shortest(widest) +
                                                    " m would overlap on the lattice");
    }
    if (m.control.latches && m.control.capture_distance > m.module.side / 2) {
      throw InputError(
          place(was_set("control.capture_distance") ? "control.capture_distance" : "module.side"),
          "control.capture_distance = " + shortest(m.control.capture_distance) +
              " m is more than half of module.side = " + shortest(m.module.side) +
              " m: faces would latch across a module");
    }
    check_rules();
  }

  // Rules with one left side share a random number; a p set here counts where it was set.
  void check_rules() {
    for (Rule& rule : draft_.rules.rules) {
      const std::string path = "rules." + rule.name + ".p";
      if (was_set(path)) rule.where = place(path);
    }
    check_probabilities(draft_.rules);
  }

  void build_forces() {
    for (const ForceDraft& force : draft_.forces) {
      if (!force.on) continue;
      Model& model = draft_.scenario.model;
      const std::string objection = force.term->objection(model, force.p);
      if (!objection.empty()) {
        const std::string base = "forces." + std::string(force.term->name()) + ".";
        const std::string path = base + objection.substr(0, objection.find(':'));
        throw InputError(place(was_set(path) ? path : base + "on"), base + objection);
      }
      model.forces.push_back({force.term, force.p});
    }
  }

  void build_field() {
    Model& m = draft_.scenario.model;
    if (draft_.source == FlowSource::file && draft_.flow_file.empty()) {
      throw InputError(place("flow.source"), "flow.source = \"file\" needs flow.file");
    }
    if (draft_.source == FlowSource::file) {
      flow_text_ = read_whole(draft_.flow_file, place("flow.file"));
      m.field = std::make_shared<const FlowField>(
          read_flow_csv(draft_.flow_file, draft_.interpolation, m.tank.radius));
    } else if (draft_.source == FlowSource::tank) {
      m.field = std::make_shared<const FlowField>(analytic_tank(draft_.tank, draft_.interpolation));
    } else {
      m.field = std::make_shared<const FlowField>(2, m.tank.radius, std::vector<FlowSample>(4),
                                                  std::vector<bool>(4, true), draft_.interpolation);
    }
  }

  void build_start() {
    StartParameters& start = draft_.scenario.model.start;
    if (start.layout != Layout::poses) return;
    if (draft_.start_file.empty()) {
      throw InputError(place("start.layout"), "start.layout = \"poses\" needs start.file");
    }
    poses_text_ = read_whole(draft_.start_file, place("start.file"));
    std::vector<int> lines;
    start.poses = parse_poses(poses_text_, draft_.start_file, &lines);
    const Model& model = draft_.scenario.model;
    const int bodies = model.bodies();
    if (static_cast<int>(start.poses.size()) != bodies) {
      throw InputError(
          SourcePlace{draft_.start_file, 0, 0},
          std::to_string(start.poses.size()) + " poses for " + std::to_string(bodies) + " bodies");
    }
    const Overlap found = deepest_overlap(model, state_of_poses(model, start.poses, 0));
    const std::string first = found.a < 0 ? "" : " (line " + std::to_string(lines[found.a]) + ")";
    const std::string objection = start_objection(model, found, first);
    if (!objection.empty()) throw InputError({draft_.start_file, lines[found.b], 0}, objection);
  }

  void build_commands() {
    const std::vector<CommandTable>* tables = nullptr;
    for (const Layer& layer : layers_) {
      if (layer.has_commands) tables = &layer.commands;
    }
    Model& m = draft_.scenario.model;
    if (tables != nullptr) commands_ = read_commands(*tables, m.module.count, command_files_);
    if (!draft_.ruleset_file.empty()) m.rulesets.push_back(draft_.rules);
    if (!command_files_.empty() && m.rulesets.empty()) {
      throw InputError(place("command"),
                       "a command replaces the ruleset, but no ruleset.file is set to begin with");
    }
    for (const RulesetFile& f : command_files_) {
      m.rulesets.push_back(parse_ruleset(f.content, f.file));
    }
    for (ScheduledCommand& scheduled : commands_) {
      Command& command = scheduled.command;
      if (scheduled.file >= 0) command.ruleset = 1 + scheduled.file;
      if (command.kind == CommandKind::pump_power) command.field = field_at(scheduled.power);
      (command.copies > 0 ? m.feedback : m.commands).push_back(command);
    }
    if (m.feedback.empty()) return;
    for (const Ruleset& rules : m.rulesets) {
      if (!final_labels(rules).empty()) continue;
      throw InputError(place("command"), "ruleset '" + rules.name +
                                             "' has no last join, so its labels do not show "
                                             "completed copies");
    }
    if (m.rulesets.empty())
      throw InputError(place("command"), "command.copies needs a ruleset.file");
  }

  // Index of the flow at a pump power (%), as Command::field. A measured flow goes with the power.
  int field_at(double power) {
    Model& m = draft_.scenario.model;
    if (draft_.source == FlowSource::still)
      throw InputError(place("flow.source"), "still water has no pumps to set");
    if (power == draft_.tank.pump_power) return 0;
    if (draft_.source == FlowSource::file && draft_.tank.pump_power == 0) {
      throw InputError(place("flow.pump_power"),
                       "flow.pump_power, at which flow.file was measured, is 0");
    }
    const auto known = std::find(powers_.begin(), powers_.end(), power);
    const auto index = static_cast<int>(known - powers_.begin());
    if (known != powers_.end()) return 1 + index;
    powers_.push_back(power);
    AnalyticTank tank = draft_.tank;
    tank.pump_power = power;
    m.other_fields.push_back(std::make_shared<const FlowField>(
        draft_.source == FlowSource::tank ? analytic_tank(tank, draft_.interpolation)
                                          : scaled(*m.field, power / draft_.tank.pump_power)));
    return 1 + index;
  }

  // Copies that end the run must be possible with one of its rulesets.
  void check_end() {
    EndParameters& end = draft_.scenario.end;
    if (!end.metric_text.empty()) {
      try {
        end.metric = end_metric(end.metric_text, draft_.scenario.model.module.count);
      } catch (const InputError& e) {
        throw InputError(place("run.until_metric"), "run.until_metric " + std::string(e.what()));
      }
    }
    if (end.until == RunUntil::end && end.copies == 0) return;
    const Model& m = draft_.scenario.model;
    int most = 0;
    for (const Ruleset& rules : m.rulesets) {
      most = std::max(most, possible_copies(rules, m.module.count));
    }
    const std::string enough = std::to_string(m.module.count) + " modules are enough for " +
                               std::to_string(most) + (most == 1 ? " copy" : " copies");
    if (end.copies > most) {
      throw InputError(place("run.until_copies"),
                       "run.until_copies = " + std::to_string(end.copies) + ", but " +
                           (m.rulesets.empty() ? "there is no ruleset.file" : enough));
    }
    if (end.until == RunUntil::all_copies && most == 0) {
      throw InputError(place("run.until"),
                       "run.until = \"all_copies\", but " +
                           (m.rulesets.empty() ? "there is no ruleset.file" : enough));
    }
  }

  Scenario finish() {
    Scenario& s = draft_.scenario;
    s.entries = entries_of(keys_, places_);
    if (!rules_text_.empty()) s.files.push_back({kRulesetName, rules_text_});
    for (std::size_t i = 0; i < command_files_.size(); ++i) {
      s.files.push_back({command_ruleset_name(i), command_files_[i].content});
    }
    if (!flow_text_.empty()) s.files.push_back({kFlowName, flow_text_});
    if (!poses_text_.empty()) s.files.push_back({kPosesName, poses_text_});
    draft_.flow_file = flow_text_.empty() ? "" : kFlowName;
    draft_.ruleset_file = rules_text_.empty() ? "" : kRulesetName;
    draft_.start_file = poses_text_.empty() ? "" : kPosesName;
    s.resolved = resolved_text(keys_, commands_);
    s.identity = identity_of(s);
    return std::move(s);
  }

  std::vector<Layer> layers_;
  ScenarioDraft draft_;
  std::vector<ScenarioKey> keys_;
  std::map<std::string, SourcePlace> places_;  // of what was set
  std::vector<ScheduledCommand> commands_;
  std::vector<RulesetFile> command_files_;
  std::vector<double> powers_;  // of Model::other_fields
  std::string rules_text_, flow_text_, poses_text_;
};

}  // namespace

Scenario load_scenario(const std::vector<std::string>& files,
                       const std::vector<std::string>& sets) {
  return build_scenario(read_layers(files, sets));
}

Scenario build_scenario(std::vector<Layer> layers) {
  return Loader(std::move(layers)).load();
}

}  // namespace lilytank
