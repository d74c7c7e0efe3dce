#include "optimize/source.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "io/scenario_layers.hpp"
#include "lilytank/assembly_record.hpp"
#include "lilytank/random.hpp"
#include "optimize/assignments.hpp"
#include "study/run_world.hpp"
#include "study/study_inputs.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

Layer seed_layer() {
  Layer out;
  out.values.push_back(named({"run", "seed"}, std::int64_t{0}));
  return out;
}

/// The probability that an assignment gives to a rule, if there is a rule of this name.
void set_p(Ruleset& rules, const Assignment& path, double p) {
  for (Rule& rule : rules.rules) {
    if (rule.name == path.keys[1]) rule.p = p, rule.where = path.place;
  }
}

/// A fitness counts copies: whichever ruleset is in force, there must be some to count.
void check_copies(const Model& model, const SourcePlace& place) {
  for (const Ruleset& rules : model.rulesets) {
    if (rules.target.empty()) {
      throw InputError(place, "the ruleset has no target whose copies could be counted");
    }
    if (possible_copies(rules, model.module.count) > 0) continue;
    throw InputError(place, std::to_string(model.module.count) + " modules make no copy of " +
                                std::to_string(rules.target.size()));
  }
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

Optimization::Source::Source(const Source& other, Ruleset instead)
    : file(other.file),
      plan(other.plan),
      ruleset(std::move(instead)),
      files_(other.files_),
      base_(other.base_),
      overrides_(other.overrides_) {
  const SearchSpace space = std::exchange(plan.space, {});
  const std::vector<double> start = std::exchange(plan.start, {});
  check_names();
  prepare();
  // Rules of the same name take back a join of the same number: what is known of one is a start for
  // the other.
  for (std::size_t i = 0; i < plan.space.size(); ++i) {
    for (std::size_t k = 0; k < space.size(); ++k) {
      if (space[k].name == plan.space[i].name) plan.start[i] = start[k];
    }
  }
}

// What is said of a rule that another ruleset lacks cannot be unsaid by an overlay: what were found
// of that ruleset could not be laid over the scenario.
void Optimization::Source::check_names() const {
  std::vector<Layer> said = base_;
  said.push_back(overrides_);
  for (const Layer& layer : said) {
    for (const Assignment& value : layer.values) {
      const auto named = [&](const Rule& rule) { return rule.name == value.keys[1]; };
      if (!is_rule(value)) continue;
      if (std::any_of(ruleset->rules.begin(), ruleset->rules.end(), named)) continue;
      throw InputError(value.place, "'" + value.path() + "' is no rule of '" + ruleset->name +
                                        "', a ruleset of the race, which an overlay cannot "
                                        "change: set p in the ruleset's file");
    }
  }
}

// Another ruleset is in memory alone: the scenario is built with its own, and the other one put in
// that one's place. What the files say of rules of its own is not about rules with the same names;
// what is searched and what --set says is.
Scenario Optimization::Source::built(Layer point) const {
  std::vector<Assignment> searched;
  if (ruleset) {
    std::copy_if(point.values.begin(), point.values.end(), std::back_inserter(searched), is_rule);
    std::erase_if(point.values, is_rule);
  }
  std::vector<Layer> all = base_;
  all.push_back(std::move(point));
  all.push_back(overrides_);
  all.push_back(seed_layer());
  Scenario out = build_scenario(std::move(all));
  if (!ruleset || out.model.rulesets.empty()) return out;
  const Ruleset own = std::exchange(out.model.rulesets.front(), *ruleset);
  Ruleset& rules = out.model.rulesets.front();
  for (const Assignment& value : searched) set_p(rules, value, std::get<double>(value.value));
  for (const Assignment& value : overrides_.values) {
    for (const Rule& rule : own.rules) {
      if (is_rule(value) && rule.name == value.keys[1]) set_p(rules, value, rule.p);
    }
  }
  check_probabilities(rules);
  return out;
}

Scenario Optimization::Source::with_overlay(const std::string& overlay) const {
  std::vector<std::string> files = files_;
  files.push_back(overlay);
  std::vector<Layer> all = read_layers(files, {});
  all.push_back(overrides_);
  all.push_back(seed_layer());
  return build_scenario(std::move(all));
}

std::vector<std::string> Optimization::Source::inputs() const {
  std::vector<std::string> files = files_;
  files.insert(files.end(), file.compare.overlays.begin(), file.compare.overlays.end());
  std::vector<Layer> layers = read_layers(files, {});
  layers.push_back(overrides_);
  files.push_back(file.hybrid_place.file);
  if (file.race) files.push_back(file.race->target);
  return with_files_of(layers, std::move(files));
}

void Optimization::Source::prepare() {
  const Scenario base = built({});
  refuse_early_end(base, "a search leaves each run once all copies have been completed");
  plan.name = file.name, plan.scenarios = files_;
  plan.seed = file.seed, plan.fitness = file.fitness;
  plan.horizon = base.duration;
  plan.hybrid = file.hybrid, plan.agitation = file.agitation.kind;
  plan.method = file.method == SearchMethod::swarm ? "swarm" : "cma_es";
  plan.replicates = file.compare.replicates;
  check_base(base.model);
  plan.possible = possible_copies(base.model.rulesets.front(), base.model.module.count);
  for (const OptimizeParameter& parameter : file.parameters) add_parameter(parameter, base);
  if (file.hybrid) add_second_set();
  if (plan.agitation != Agitation::none) add_agitation(base);
  check_overrides();
  check_corners();
  plan.budget = checked_budget();
}

void Optimization::Source::check_overrides() const {
  for (const Assignment& value : overrides_.values) {
    for (const SearchAxis& axis : plan.space) {
      const bool power = axis.name == "power.0" && value.path() == "flow.pump_power";
      if (axis.name == value.path() || power) {
        throw InputError(value.place, "'" + value.path() + "' is searched");
      }
    }
  }
}

void Optimization::Source::check_base(const Model& model) const {
  const SourcePlace place{files_.front(), 0, 0};
  if (model.rulesets.empty()) {
    throw InputError(place, "there is no ruleset.file whose probabilities could be searched");
  }
  check_copies(model, place);
  if (!file.hybrid && plan.agitation == Agitation::none) return;
  for (const Layer& layer : base_) {
    if (layer.commands.empty()) continue;
    throw InputError(layer.commands.front().place,
                     "a hybrid strategy and agitation are given by commands of their own: take "
                     "those of the scenario away");
  }
}

// Bounds of the search that the scenario does not allow come to light before the first world.
void Optimization::Source::check_corners() const {
  std::vector<double> low, high;
  for (const SearchAxis& axis : plan.space) low.push_back(axis.low), high.push_back(axis.high);
  for (const auto& point : {plan.start, low, high}) {
    const Scenario at = scenario(point);
    check_copies(at.model, {file.hybrid_place.file, 0, 0});
    if (point == plan.start) static_cast<void>(initial_state(at.model, 0));  // do they fit?
  }
}

// Reports a number that the search refuses at its place in the file.
std::int64_t Optimization::Source::checked_budget() const {
  const std::string& where = file.hybrid_place.file;
  const CmaEsOptions& o = file.cma_es;
  if (file.method == SearchMethod::cma_es && o.final_evaluations > o.budget) {
    throw InputError(place_in(where, {"optimize.final_evaluations"}),
                     "optimize.final_evaluations = " + std::to_string(o.final_evaluations) +
                         " is more than optimize.evaluations = " + std::to_string(o.budget));
  }
  try {
    return (ruleset ? winners_search(plan.start) : search())->budget();
  } catch (const InputError& e) {
    std::vector<std::string> paths;
    for (const char* key :
         {"final_evaluations", "evaluations", "population", "sigma", "particles", "iterations"}) {
      paths.push_back(std::string("optimize.") + key);
    }
    throw InputError(place_in(where, paths), e.what());
  }
}

Scenario Optimization::Source::scenario(const std::vector<double>& point) const {
  const DecodedPoint what = decoded(point);
  Scenario out = built(layer(what));
  if (what.after_copies == 0) return out;
  Model& model = out.model;
  if (final_labels(model.rulesets.front()).empty()) {
    throw InputError(file.hybrid_place,
                     "the ruleset has no last join, so its labels do not show completed "
                     "copies");
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

double Optimization::Source::evaluate(const Trial& trial, const JobControl& control) const {
  // As a study's replicates, so that `lilytank run --seed` takes the seed.
  const std::uint64_t seed =
      derived_seed(plan.seed, static_cast<std::uint64_t>(trial.replicate)) >> 5;
  const Scenario at = scenario(trial.point);
  const RunRow row = run_world(at, seed, EarlyEnd::completed, control).row;
  if (row.status == RunStatus::diverged) return std::numeric_limits<double>::infinity();
  return fitness_of(plan.fitness, row.completion, row.possible, at.duration);
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

std::unique_ptr<Search> Optimization::Source::winners_search(
    const std::vector<double>& start) const {
  return cma_es(file.cma_es.budget, start, file.cma_es.sigma / 2);
}

std::int64_t Optimization::Source::generation() const {
  constexpr std::int64_t kAmple = 1'000'000;  // holds a generation of the largest population
  const auto first = cma_es(kAmple, plan.start, file.cma_es.sigma)->ask();
  return static_cast<std::int64_t>(first.size());
}

std::string Optimization::Source::identity() const {
  Fnv hash;
  hash.add("2 " + std::to_string(built({}).identity));
  if (ruleset) hash.add(to_text(*ruleset));
  for (const double number : {static_cast<double>(plan.fitness.fitness), plan.fitness.rate_weight,
                              plan.fitness.yield_weight, static_cast<double>(plan.hybrid),
                              static_cast<double>(plan.agitation)}) {
    hash.add(shortest(number));
  }
  for (const Axis& axis : axes_) hash.add(axis.whole ? "whole" : "real");
  return "lilytank optimize 1 " + std::to_string(hash.value());
}

}  // namespace lilytank
