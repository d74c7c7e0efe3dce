// From a plan to rules.
#include <algorithm>

#include "lilytank/synthesis.hpp"
#include "model/ruleset_scanner.hpp"
#include "synthesis/tree.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

// State of a cell's module while the plan is carried out.
struct Engaged {
  int label = 0;
  int last = -1;  // direction of l_n, -1: isolated
};

class Emitter {
 public:
  explicit Emitter(const Target& target) : target_(target), cells_(target.cells.size()) {}

  void join(const Contact& contact, const std::string& name) {
    const int out = direction_of(target_, contact.a, contact.b), back = (out + 2) & 3;
    const Label first = before(contact.a, out), second = before(contact.b, back);
    const Label after_a{++labels_, 1}, after_b{++labels_, 1};
    if (labels_ > 255)
      throw InputError("the rules of " + target_.name +
                       " need more than the 255 control states that there are");
    forward.push_back({name, RuleKind::link, {first, second}, {after_a, after_b}});
    const auto undone = [](const Label& l) { return Label{l.state, reverse_hop(l.hop)}; };
    const std::array<Label, 2> taken_back{undone(first), undone(second)};
    reverse.push_back({name + "_reverse", RuleKind::unlink, {after_a, after_b}, taken_back, 0});
    cells_[contact.a] = {after_a.state, out};
    cells_[contact.b] = {after_b.state, back};
  }

  std::vector<Rule> forward, reverse;

 private:
  Label before(int cell, int direction) const {
    const Engaged& engaged = cells_[cell];
    return {engaged.label, hop_of(engaged.last, direction)};
  }
  const Target& target_;
  std::vector<Engaged> cells_;
  int labels_ = 0;  // control states used so far
};

// Contacts that close a loop once `a` and `b` have both made their last join, at most one a cell:
// a second one would need to know whether the first has been made.
std::vector<Contact> closable(const Target& target, const Plan& plan) {
  std::vector<int> last(target.cells.size(), -1);
  for (std::size_t k = 0; k < plan.joins.size(); ++k)
    for (const int cell : {plan.joins[k].a, plan.joins[k].b}) last[cell] = static_cast<int>(k);
  std::vector<bool> used(target.cells.size(), false);
  std::vector<Contact> found;
  for (const Contact& contact : open_contacts(target, plan)) {
    const auto a = static_cast<std::size_t>(contact.a), b = static_cast<std::size_t>(contact.b);
    // The join that makes the two touch must be the last thing that either of them does.
    Parts parts(static_cast<int>(target.cells.size()));
    std::size_t k = 0;
    while (k < plan.joins.size() && parts.find(contact.a) != parts.find(contact.b)) {
      parts.join(plan.joins[k].a, plan.joins[k].b);
      ++k;
    }
    const int touch = static_cast<int>(k) - 1;
    if (last[a] > touch || last[b] > touch || used[a] || used[b]) continue;
    used[a] = used[b] = true;
    found.push_back(contact);
  }
  return found;
}

double usual_p(int modules) {
  return modules <= 2 ? 0.01 : modules == 3 ? 0.005 : 0.000025;
}

void set_probabilities(const Target& target, const Plan& plan, const EmitOptions& options,
                       Emitter& rules) {
  if (options.p.size() > plan.joins.size())
    throw InputError(std::to_string(options.p.size()) + " probabilities are given for " +
                     std::to_string(plan.joins.size()) + " joins");
  const std::vector<int> maximal = maximal_joins(target, plan);
  Parts parts(static_cast<int>(target.cells.size()));
  int seeds = 0;
  for (std::size_t k = 0; k < plan.joins.size(); ++k) {
    parts.join(plan.joins[k].a, plan.joins[k].b);
    const bool last =
        std::find(maximal.begin(), maximal.end(), static_cast<int>(k)) != maximal.end();
    double& p = rules.reverse[k].p;
    p = k < options.p.size() ? options.p[k] : last ? 0 : usual_p(parts.size(plan.joins[k].a));
    if (rules.forward[k].before[0] == Label{} && rules.forward[k].before[1] == Label{}) ++seeds;
  }
  for (Rule& rule : rules.forward)
    if (rule.before[0] == Label{} && rule.before[1] == Label{}) rule.p = 1.0 / seeds;
}

}  // namespace

Ruleset emit(const Target& target, const Plan& plan, const EmitOptions& options) {
  check_plan(target, plan);
  Emitter emitter(target);
  for (std::size_t k = 0; k < plan.joins.size(); ++k)
    emitter.join(plan.joins[k], "r" + std::to_string(k + 1));
  set_probabilities(target, plan, options, emitter);
  if (options.closures) {
    int number = 0;
    for (const Contact& contact : closable(target, plan))
      emitter.join(contact, "c" + std::to_string(++number));
  }
  Ruleset rules;
  rules.name = target.name;
  rules.target = target.cells;
  rules.file = target.file;
  rules.rules = std::move(emitter.forward);
  rules.rules.insert(rules.rules.end(), emitter.reverse.begin(), emitter.reverse.end());
  check_probabilities(rules);
  return rules;
}

std::vector<Stage> stages_of(const Target& target, const Plan& plan) {
  check_plan(target, plan);
  const Ruleset rules = emit(target, plan);
  std::vector<StageModule> all(target.cells.size());
  std::vector<bool> placed(target.cells.size(), false);
  for (std::size_t k = 0; k < all.size(); ++k) all[k].cell = static_cast<int>(k);
  std::vector<Stage> stages;
  const auto take = [&](const Rule* rule) {
    Stage stage;
    if (rule != nullptr) stage.rule = rule->name, stage.text = rule_text(*rule);
    for (std::size_t k = 0; k < all.size(); ++k)
      if (placed[k]) stage.modules.push_back(all[k]);
    stages.push_back(std::move(stage));
  };
  placed[plan.joins.front().a] = true;
  take(nullptr);
  for (std::size_t k = 0; k < plan.joins.size(); ++k) {
    for (StageModule& module : all) module.engaged = false;
    const Contact& join = plan.joins[k];
    const int out = direction_of(target, join.a, join.b);
    for (int side = 0; side < 2; ++side) {
      const auto cell = static_cast<std::size_t>(side == 0 ? join.a : join.b);
      const int direction = side == 0 ? out : (out + 2) & 3;
      StageModule& module = all[cell];
      module.label = rules.rules[k].after[side].state;
      module.last = direction;
      module.bonds |= 1u << direction;
      module.engaged = placed[cell] = true;
    }
    take(&rules.rules[k]);
  }
  return stages;
}

}  // namespace lilytank
