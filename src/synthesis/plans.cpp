// All plans of a target, and when two of them come to the same.
#include <algorithm>
#include <map>
#include <set>

#include "lilytank/synthesis.hpp"
#include "synthesis/orders.hpp"
#include "synthesis/tree.hpp"
#include "text/fnv.hpp"

namespace lilytank {
namespace {

using Orders = std::vector<std::vector<Contact>>;

// Calls visit for every way to order each module's neighbours, as long as visit returns true.
template <class Visit>
bool for_each_order(Neighbours& tree, std::size_t node, const Visit& visit) {
  if (node == tree.size()) return visit();
  std::sort(tree[node].begin(), tree[node].end());
  do {
    if (!for_each_order(tree, node + 1, visit)) return false;
  } while (std::next_permutation(tree[node].begin(), tree[node].end()));
  return true;
}

// Balanced orders over every choice among equally good edges.
Orders balanced_orders(int nodes, const std::vector<Contact>& edges, std::size_t limit) {
  if (edges.empty()) return {{}};
  const auto tree = neighbours_of(nodes, edges);
  Orders found;
  for (const int index : most_equal_edges(tree, edges)) {
    const Contact cut = edges[index];
    const std::vector<int> near = side_of(tree, cut.a, cut.b);
    std::vector<Contact> part[2];
    for (const Contact& edge : edges) {
      if (edge == cut) continue;
      const bool in = std::find(near.begin(), near.end(), edge.a) != near.end();
      part[in ? 0 : 1].push_back(edge);
    }
    const Orders first = balanced_orders(nodes, part[0], limit);
    const Orders second = balanced_orders(nodes, part[1], limit);
    for (const auto& a : first) {
      for (const auto& b : second) {
        if (found.size() >= limit) return found;
        std::vector<Contact> joins = a;
        joins.insert(joins.end(), b.begin(), b.end());
        joins.push_back(cut);
        found.push_back(larger_part_first(nodes, std::move(joins)));
      }
    }
  }
  return found;
}

// Gathers the plans of a target tree by tree.
class Collector {
 public:
  Collector(const Target& target, const PlanLimits& limits) : target_(target), limits_(limits) {}

  void tree(const std::vector<Contact>& edges) {
    const int nodes = static_cast<int>(target_.cells.size());
    const auto next_to = neighbours_of(nodes, edges);
    Neighbours turned = next_to;
    for_each_order(turned, 0, [&] {
      for (const int leaf : end_leaves(next_to))
        if (!add(Algorithm::singleton, growth_from(turned, leaf))) return false;
      return true;
    });
    keep_best();
    turned = next_to;
    for_each_order(turned, 0, [&] {
      for (const Contact& edge : edges)
        if (!add(Algorithm::linchpin, linchpin_order(turned, edge))) return false;
      return true;
    });
    keep_best();
    for (auto& joins : balanced_orders(nodes, edges, limits_.orders))
      add(Algorithm::balanced, std::move(joins));
    keep_best();
  }

  PlanList take() {
    PlanList list;
    list.complete = complete_;
    const bool any_free =
        std::any_of(found_.begin(), found_.end(), [](const Found& f) { return !f.blocked; });
    for (Found& found : found_)
      if (!any_free || !found.blocked) list.plans.push_back(std::move(found.plan));
    // The same rules under two algorithms' names are one plan, that of the first.
    std::set<std::uint64_t> known;
    std::stable_sort(list.plans.begin(), list.plans.end(),
                     [](const Plan& a, const Plan& b) { return a.algorithm < b.algorithm; });
    std::erase_if(list.plans, [&](const Plan& plan) {
      return !known.insert(structure_of(emit(target_, plan))).second;
    });
    return list;
  }

  bool full() const { return found_.size() >= limits_.plans; }
  void cut() { complete_ = false; }

 private:
  struct Found {
    Plan plan;
    bool blocked = false;
  };

  // False once a tree and algorithm have as many orders as are allowed.
  bool add(Algorithm algorithm, std::vector<Contact> joins) {
    if (!tried_.insert(joins).second) return true;
    if (candidates_.size() >= limits_.orders) return complete_ = false;
    candidates_.push_back({algorithm, std::move(joins)});
    return true;
  }

  void keep_best() {
    std::size_t least = target_.cells.size();
    for (const Plan& plan : candidates_)
      least = std::min(least, maximal_joins(target_, plan).size());
    for (Plan& plan : candidates_) {
      if (maximal_joins(target_, plan).size() > least) continue;
      if (!known_.insert({plan.algorithm, structure_of(emit(target_, plan))}).second) continue;
      if (full()) {
        complete_ = false;
        break;
      }
      const bool blocked = !blocked_joins(target_, plan).empty();
      found_.push_back({std::move(plan), blocked});
    }
    candidates_.clear();
    tried_.clear();
  }

  const Target& target_;
  const PlanLimits& limits_;
  std::vector<Found> found_;
  std::set<std::pair<Algorithm, std::uint64_t>> known_;
  std::vector<Plan> candidates_;  // of one tree and algorithm
  std::set<std::vector<Contact>> tried_;
  bool complete_ = true;
};

}  // namespace

PlanList all_plans(const Target& target, const PlanLimits& limits) {
  Collector collector(target, limits);
  const auto trees = spanning_trees(target, limits.trees);
  if (trees.size() == limits.trees) collector.cut();
  for (const std::vector<Contact>& tree : trees) {
    if (collector.full()) {
      collector.cut();
      break;
    }
    collector.tree(tree);
  }
  return collector.take();
}

// Colours of control states and rules are refined by each other until they distinguish all that can
// be distinguished [Weisfeiler and Leman, 1968]; names and order do not enter.
std::uint64_t structure_of(const Ruleset& rules) {
  std::map<int, std::uint64_t> colour = {{0, 1}};
  for (const Rule& rule : rules.rules) {
    for (const Label& label : rule.before) colour.try_emplace(label.state, 2);
    for (const Label& label : rule.after) colour.try_emplace(label.state, 2);
  }
  const auto hash = [](const std::vector<std::uint64_t>& values) {
    Fnv fnv;
    for (const std::uint64_t value : values)
      fnv.add({reinterpret_cast<const char*>(&value), sizeof value});
    return fnv.value();
  };
  std::vector<std::uint64_t> of_rules(rules.rules.size());
  for (std::size_t round = 0; round <= colour.size() + 1; ++round) {
    std::map<int, std::vector<std::uint64_t>> seen;
    for (std::size_t k = 0; k < rules.rules.size(); ++k) {
      const Rule& rule = rules.rules[k];
      std::uint64_t side[2];
      for (std::size_t s = 0; s < 2; ++s) {
        side[s] =
            hash({colour[rule.before[s].state], static_cast<std::uint64_t>(rule.before[s].hop),
                  colour[rule.after[s].state], static_cast<std::uint64_t>(rule.after[s].hop)});
      }
      of_rules[k] = hash({static_cast<std::uint64_t>(rule.kind), std::min(side[0], side[1]),
                          std::max(side[0], side[1])});
      for (std::size_t s = 0; s < 2; ++s) {
        seen[rule.before[s].state].push_back(hash({1, of_rules[k], side[s]}));
        seen[rule.after[s].state].push_back(hash({2, of_rules[k], side[s]}));
      }
    }
    for (auto& [state, list] : seen) {
      std::sort(list.begin(), list.end());
      list.push_back(colour[state]);
      if (state != 0) colour[state] = hash(list);
    }
  }
  std::sort(of_rules.begin(), of_rules.end());
  return hash(of_rules);
}

}  // namespace lilytank
