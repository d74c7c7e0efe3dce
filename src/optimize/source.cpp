#include "optimize/source.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "io/scenario_build.hpp"
#include "lilytank/assembly_record.hpp"
#include "lilytank/random.hpp"
#include "study/run_world.hpp"
#include "text/fnv.hpp"
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

bool is_rule(const Assignment& path) {
  return path.keys.size() == 3 && path.keys.front() == "rules" && path.keys.back() == "p";
}

Assignment valued(Assignment path, TomlValue value) {
  path.value = std::move(value);
  return path;
}

Assignment named(const std::vector<std::string>& keys, TomlValue value) {
  return {keys, std::vector<SourcePlace>(keys.size()), std::move(value), {}, "", ""};
}

std::optional<double> value_of(const Scenario& scenario, const std::string& path) {
  for (const ScenarioEntry& entry : scenario.entries) {
    if (entry.path == path) return parse_number(entry.value);
  }
  return std::nullopt;
}

/// Where a file has the first of these keys of [optimize] that it has; else the file.
SourcePlace place_in(const std::string& file, const std::vector<std::string>& keys) {
  const Layer layer = read_layers({file}, {}).front();
  for (const std::string& key : keys) {
    for (const Assignment& value : layer.values) {
      if (value.path() == "optimize." + key) return value.place;
    }
  }
  return {file, 0, 0};
}

}  // namespace

Optimization::Source::Source(OptimizeFile what, std::vector<std::string> overlays,
                             std::vector<std::string> sets)
    : file(std::move(what)), files_(file.scenarios) {
  files_.insert(files_.end(), overlays.begin(), overlays.end());
  base_ = read_layers(files_, {});
  overrides_ = read_layers({}, sets).back();
  plan.sets = std::move(sets);
  prepare();
}

Optimization::Source::Source(const Source& other, OtherRuleset ruleset)
    : file(other.file),
      plan(other.plan),
      files_(other.files_),
      base_(other.base_),
      overrides_(other.overrides_),
      ruleset_{std::move(ruleset)} {
  const SearchSpace space = std::exchange(plan.space, {});
  const std::vector<double> start = std::exchange(plan.start, {});
  prepare();
  // Rules of the same name take back a join of the same number: what is known of one is a start for
  // the other.
  for (std::size_t i = 0; i < plan.space.size(); ++i) {
    for (std::size_t k = 0; k < space.size(); ++k) {
      if (space[k].name == plan.space[i].name) plan.start[i] = start[k];
    }
  }
}

std::vector<Layer> Optimization::Source::layers() const {
  std::vector<Layer> out = base_;
  for (const OtherRuleset& other : ruleset_) {
    Layer layer;
    layer.values.push_back(named({"ruleset", "file"}, other.file));
    // What the scenario says of rules with these names is not about these.
    for (const Rule& rule : other.rules.rules) {
      layer.values.push_back(named({"rules", rule.name, "p"}, rule.p));
    }
    out.push_back(std::move(layer));
  }
  return out;
}

Scenario Optimization::Source::built(Layer point) const {
  std::vector<Layer> all = layers();
  all.push_back(std::move(point));
  all.push_back(overrides_);
  Layer seed;
  seed.values.push_back(named({"run", "seed"}, std::int64_t{0}));
  all.push_back(std::move(seed));
  return build_scenario(std::move(all));
}

void Optimization::Source::prepare() {
  const Scenario base = built({});
  plan.name = file.name, plan.scenarios = files_;
  plan.seed = file.seed, plan.fitness = file.fitness;
  plan.horizon = base.duration;
  plan.possible = base.model.rulesets.empty()
                      ? 0
                      : possible_copies(base.model.rulesets.front(), base.model.module.count);
  plan.hybrid = file.hybrid, plan.agitation = file.agitation.kind;
  plan.method = file.method == SearchMethod::swarm ? "swarm" : "cma_es";
  plan.replicates = file.compare.replicates;
  check_base(base.model);
  for (const OptimizeParameter& parameter : file.parameters) add_parameter(parameter, base);
  if (file.hybrid) add_second_set();
  if (plan.agitation != Agitation::none) {
    add_agitation(value_of(base, "flow.pump_power").value_or(0));
  }
  for (const Assignment& value : overrides_.values) {
    for (const SearchAxis& axis : plan.space) {
      const bool power = axis.name == "power.0" && value.path() == "flow.pump_power";
      if (axis.name == value.path() || power) {
        throw InputError(value.place, "'" + value.path() + "' is searched");
      }
    }
  }
  check_corners();
  plan.budget = checked_budget();
}

void Optimization::Source::check_base(const Model& model) const {
  const SourcePlace place{files_.front(), 0, 0};
  if (model.rulesets.empty() || model.rulesets.front().target.empty()) {
    throw InputError(place, model.rulesets.empty()
                                ? "there is no ruleset.file whose probabilities could be searched"
                                : "the ruleset has no target whose copies could be counted");
  }
  if (plan.possible == 0) {
    throw InputError(place, std::to_string(model.module.count) + " modules make no copy of " +
                                std::to_string(model.rulesets.front().target.size()));
  }
  if (!file.hybrid && plan.agitation == Agitation::none) return;
  for (const Layer& layer : base_) {
    if (layer.commands.empty()) continue;
    throw InputError(layer.commands.front().place,
                     "a hybrid strategy and agitation are given by commands of their own: take "
                     "those of the scenario away");
  }
}

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
    // A rule that is not there is refused, with the nearest name, where the scenario is built.
    if (paths.empty() && !star) paths.push_back(parameter.path);
  }
  if (paths.empty()) {
    throw InputError(parameter.path.place,
                     "'" + parameter.path.path() + "' fits no rule that can undo a bond (p > 0)");
  }
  for (const Assignment& path : paths) {
    const auto now = value_of(base, path.path());
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

void Optimization::Source::add_agitation(double power) {
  const AgitationTable& table = file.agitation;
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

// Bounds of the search that the scenario does not allow come to light before the first world.
void Optimization::Source::check_corners() const {
  std::vector<double> low, high;
  for (const SearchAxis& axis : plan.space) low.push_back(axis.low), high.push_back(axis.high);
  for (const auto& point : {plan.start, low, high}) {
    const Scenario at = scenario(point);
    if (point == plan.start) static_cast<void>(initial_state(at.model, 0));  // do they fit?
  }
}

// What a search refuses of its numbers is told where the file has them.
std::int64_t Optimization::Source::checked_budget() const {
  const std::string& where = file.hybrid_place.file;
  const CmaEsOptions& o = file.cma_es;
  if (file.method == SearchMethod::cma_es && o.final_evaluations > o.budget) {
    throw InputError(place_in(where, {"final_evaluations"}),
                     "optimize.final_evaluations = " + std::to_string(o.final_evaluations) +
                         " is more than optimize.evaluations = " + std::to_string(o.budget));
  }
  try {
    return search()->budget();
  } catch (const InputError& e) {
    const std::vector<std::string> keys{"final_evaluations", "evaluations", "population", "sigma",
                                        "particles",         "iterations"};
    throw InputError(place_in(where, keys), e.what());
  }
}

Optimization::Source::Meaning Optimization::Source::meaning(
    const std::vector<double>& point) const {
  Meaning out;
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

Layer Optimization::Source::layer(const Meaning& meaning) const {
  Layer out;
  out.values = meaning.values;
  if (meaning.powers.empty()) return out;
  out.values.push_back(named({"flow", "pump_power"}, meaning.powers.front()));
  out.has_commands = true;
  for (std::size_t i = 1; i < meaning.powers.size(); ++i) {
    CommandTable command;
    command.place = file.agitation.place;
    if (plan.agitation == Agitation::feedback) {
      command.fields.push_back(named({"copies"}, static_cast<std::int64_t>(i)));
    } else {
      command.fields.push_back(named({"at"}, meaning.changes[i - 1]));
    }
    command.fields.push_back(named({"do"}, std::string("pump_power")));
    command.fields.push_back(named({"power"}, meaning.powers[i]));
    out.commands.push_back(std::move(command));
  }
  return out;
}

Ruleset Optimization::Source::second_set(const Meaning& meaning, const Ruleset& first) const {
  Ruleset out = first;
  for (const auto& [name, p] : meaning.after) {
    for (Rule& rule : out.rules) {
      if (rule.name == name) rule.p = p, rule.where = file.hybrid_place;
    }
  }
  check_probabilities(out);
  return out;
}

Scenario Optimization::Source::scenario(const std::vector<double>& point) const {
  const Meaning what = meaning(point);
  Scenario out = built(layer(what));
  if (what.after_copies == 0) return out;
  Model& model = out.model;
  if (final_labels(model.rulesets.front()).empty()) {
    throw InputError(file.hybrid_place,
                     "the ruleset has no last join, so no finished copies can be told from its "
                     "labels");
  }
  Command command;
  command.kind = CommandKind::replace_ruleset;
  command.ruleset = static_cast<int>(model.rulesets.size());
  command.copies = what.after_copies;
  model.rulesets.push_back(second_set(what, model.rulesets.front()));
  model.feedback.push_back(std::move(command));
  std::stable_sort(model.feedback.begin(), model.feedback.end(),
                   [](const Command& a, const Command& b) { return a.copies < b.copies; });
  return out;
}

std::optional<double> Optimization::Source::evaluate(const Trial& trial,
                                                     const std::atomic<bool>* stop) const {
  // As a study's replicates, so that `lilytank run --seed` takes the seed.
  const std::uint64_t seed =
      derived_seed(plan.seed, static_cast<std::uint64_t>(trial.replicate)) >> 5;
  const auto world =
      run_world(scenario(trial.point), seed, EarlyEnd::completed, stop, [](double) {});
  if (!world) return std::nullopt;
  if (world->row.status == RunStatus::diverged) return std::numeric_limits<double>::infinity();
  return fitness_of(plan.fitness, world->row.completion, plan.possible, plan.horizon);
}

std::unique_ptr<Search> Optimization::Source::search() const {
  if (file.method == SearchMethod::swarm) {
    SwarmOptions options = file.swarm;
    if (!file.start_anywhere) options.starts = {plan.start};
    return make_swarm(plan.space, std::move(options), plan.seed);
  }
  CmaEsOptions options = file.cma_es;
  options.start = plan.start;
  return make_cma_es(plan.space, std::move(options), plan.seed);
}

std::unique_ptr<Search> Optimization::Source::cma_es(std::int64_t budget,
                                                     const std::vector<double>& start,
                                                     double sigma) const {
  CmaEsOptions options = file.cma_es;
  options.budget = budget, options.start = start, options.sigma = sigma;
  options.final_evaluations = static_cast<int>(std::max<std::int64_t>(4, budget / 4));
  return make_cma_es(plan.space, std::move(options), plan.seed);
}

std::string Optimization::Source::identity() const {
  Fnv hash;
  hash.add(std::to_string(built({}).identity));
  for (const double number : {static_cast<double>(plan.fitness.fitness), plan.fitness.rate_weight,
                              plan.fitness.yield_weight, static_cast<double>(plan.hybrid),
                              static_cast<double>(plan.agitation)}) {
    hash.add(shortest(number));
  }
  for (const Axis& axis : axes_) hash.add(axis.whole ? "whole" : "real");
  return "lilytank optimize 1 " + std::to_string(hash.value());
}

}  // namespace lilytank
