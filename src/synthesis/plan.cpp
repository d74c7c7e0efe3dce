// Plans: in which order the bonds of a spanning tree are made.
#include <algorithm>
#include <functional>

#include "lilytank/synthesis.hpp"
#include "synthesis/orders.hpp"
#include "synthesis/steric.hpp"
#include "synthesis/tree.hpp"

namespace lilytank {
namespace {

// Fewer maximal joins are better, then fewer blocked ones.
std::pair<std::size_t, std::size_t> faults(const Target& target, const Plan& plan) {
  return {maximal_joins(target, plan).size(), blocked_joins(target, plan).size()};
}

using Planner = std::function<Plan(const std::vector<Contact>&)>;

Plan best_over_trees(const Target& target, const Planner& planner) {
  constexpr std::size_t kTrees = 300;
  Plan best = planner(spanning_tree(target));
  auto least = faults(target, best);
  if (least == std::pair<std::size_t, std::size_t>{1, 0}) return best;
  for (const std::vector<Contact>& tree : spanning_trees(target, kTrees)) {
    Plan plan = planner(tree);
    const auto found = faults(target, plan);
    if (found < least) best = std::move(plan), least = found;
    if (least == std::pair<std::size_t, std::size_t>{1, 0}) break;
  }
  return best;
}

}  // namespace

const std::vector<std::string>& algorithm_names() {
  static const std::vector<std::string> names{"singleton", "linchpin", "balanced", "plan"};
  return names;
}

Algorithm algorithm_of(const std::string& name) {
  const auto& names = algorithm_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError("algorithm '" + name + "' is none of singleton, linchpin, balanced, plan" +
                     did_you_mean(name, names));
  return static_cast<Algorithm>(found - names.begin());
}

std::vector<int> maximal_joins(const Target& target, const Plan& plan) {
  std::vector<int> last(target.cells.size(), -1), found;
  for (std::size_t k = 0; k < plan.joins.size(); ++k)
    last[plan.joins[k].a] = last[plan.joins[k].b] = static_cast<int>(k);
  for (int k = 0; k < static_cast<int>(plan.joins.size()); ++k) {
    const Contact& join = plan.joins[k];
    if (last[join.a] == k && last[join.b] == k) found.push_back(k);
  }
  return found;
}

std::vector<int> blocked_joins(const Target& target, const Plan& plan) {
  const auto cells = [&](const std::vector<int>& members) {
    std::vector<Cell> found;
    for (const int k : members) found.push_back(target.cells[k]);
    return found;
  };
  Parts parts(static_cast<int>(target.cells.size()));
  std::vector<int> blocked;
  for (std::size_t k = 0; k < plan.joins.size(); ++k) {
    const Contact& join = plan.joins[k];
    if (!can_approach(cells(parts.members(join.a)), cells(parts.members(join.b)),
                      target.cells[join.a], direction_of(target, join.a, join.b)))
      blocked.push_back(static_cast<int>(k));
    parts.join(join.a, join.b);
  }
  return blocked;
}

std::vector<Contact> open_contacts(const Target& target, const Plan& plan) {
  std::vector<Contact> open = contacts_of(target);
  std::erase_if(open, [&](const Contact& contact) {
    return std::any_of(plan.joins.begin(), plan.joins.end(), [&](const Contact& join) {
      return contact == Contact{std::min(join.a, join.b), std::max(join.a, join.b)};
    });
  });
  return open;
}

void check_plan(const Target& target, const Plan& plan) {
  const int nodes = static_cast<int>(target.cells.size());
  const std::vector<Contact> contacts = contacts_of(target);
  Parts parts(nodes);
  for (std::size_t k = 0; k < plan.joins.size(); ++k) {
    const Contact edge{std::min(plan.joins[k].a, plan.joins[k].b),
                       std::max(plan.joins[k].a, plan.joins[k].b)};
    const std::string name = "join " + std::to_string(k + 1);
    if (std::find(contacts.begin(), contacts.end(), edge) == contacts.end())
      throw InputError(name + " is not between two neighbouring cells of the target");
    if (!parts.join(edge.a, edge.b)) throw InputError(name + " closes a loop: joins make a tree");
  }
  if (static_cast<int>(plan.joins.size()) != nodes - 1)
    throw InputError("a target of " + std::to_string(nodes) + " modules needs " +
                     std::to_string(nodes - 1) + " joins, the plan has " +
                     std::to_string(plan.joins.size()));
}

Plan singleton_plan(const Target& target, const std::vector<Contact>& tree) {
  const auto next_to = neighbours_of(static_cast<int>(target.cells.size()), tree);
  Plan best;
  std::pair<std::size_t, std::size_t> least;
  for (const int leaf : end_leaves(next_to)) {
    const Plan plan{Algorithm::singleton, growth_from(next_to, leaf)};
    const auto found = faults(target, plan);
    if (best.joins.empty() || found < least) best = plan, least = found;
  }
  return best;
}

Plan linchpin_plan(const Target& target, const std::vector<Contact>& tree, int linchpin) {
  const auto next_to = neighbours_of(static_cast<int>(target.cells.size()), tree);
  if (linchpin < 0) linchpin = most_equal_edges(next_to, tree).front();
  return {Algorithm::linchpin, linchpin_order(next_to, tree[linchpin])};
}

Plan balanced_plan(const Target& target, const std::vector<Contact>& tree) {
  return {Algorithm::balanced, balanced_order(static_cast<int>(target.cells.size()), tree)};
}

Plan make_plan(const Target& target, Algorithm algorithm) {
  switch (algorithm) {
    case Algorithm::singleton:
      return best_over_trees(target,
                             [&](const auto& tree) { return singleton_plan(target, tree); });
    case Algorithm::linchpin:
      return best_over_trees(target, [&](const auto& tree) { return linchpin_plan(target, tree); });
    case Algorithm::balanced:
      return best_over_trees(target, [&](const auto& tree) { return balanced_plan(target, tree); });
    case Algorithm::plan:
      break;
  }
  if (!target.ordered)
    throw InputError({target.file, 0, 0},
                     "algorithm 'plan' needs a drawing whose bonds are numbered in their order, "
                     "as '#1#2#'");
  return {Algorithm::plan, larger_part_first(static_cast<int>(target.cells.size()), target.bonds)};
}

}  // namespace lilytank
