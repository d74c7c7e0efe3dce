// Every state of M modules, by how many assemblies of each species there are, and where it ends.
#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <unordered_map>

#include "lilytank/lattice.hpp"

namespace lilytank {
namespace {

// Numbers of assemblies by species, two bytes each: a key that is quick to compare.
using Counts = std::basic_string<char16_t>;

class Graph {
 public:
  Graph(const ReactionNetwork& network, std::vector<const Reaction*> reactions, std::int64_t limit)
      : network_(network), reactions_(std::move(reactions)), limit_(limit) {}

  // False if there are more states than the limit.
  bool explore(int modules, const JobControl& control) {
    Counts start(network_.species.size(), u'\0');
    start[0] = static_cast<char16_t>(modules);
    add(start);
    for (std::size_t k = 0; k < states_.size(); ++k) {
      if (static_cast<std::int64_t>(states_.size()) > limit_) return false;
      control.check_stop();
      const Counts now = *states_[k];
      for (const Reaction* reaction : reactions_) {
        Counts then = now;
        bool enough = true;
        for (const int species : reaction->from) enough = enough && then[species]-- > 0;
        if (!enough) continue;
        for (const int species : reaction->to) ++then[species];
        const int to = add(then);
        if (to != static_cast<int>(k)) next_[k].push_back(to);
      }
    }
    return true;
  }

  std::int64_t states() const { return static_cast<std::int64_t>(states_.size()); }

  std::vector<EndState> ends() const {
    const std::vector<int> component = components();
    std::map<int, bool> left;  // by component: some edge leaves it
    for (std::size_t k = 0; k < next_.size(); ++k) {
      bool& leaves = left[component[k]];
      for (const int to : next_[k]) leaves = leaves || component[to] != component[k];
    }
    std::map<int, EndState> found;
    for (std::size_t k = 0; k < next_.size(); ++k) {
      if (left[component[k]]) continue;
      const int standing = copies(static_cast<int>(k));
      const auto [at, fresh] = found.try_emplace(component[k]);
      EndState& end = at->second;
      if (fresh) {
        end.counts.assign(states_[k]->begin(), states_[k]->end());
        end.copies = end.fewest_copies = standing;
        continue;
      }
      ++end.states;
      end.copies = std::max(end.copies, standing);
      end.fewest_copies = std::min(end.fewest_copies, standing);
    }
    std::vector<EndState> ends;
    for (auto& [number, end] : found) ends.push_back(std::move(end));
    return ends;
  }

 private:
  int add(const Counts& counts) {
    const auto [at, fresh] = index_.try_emplace(counts, static_cast<int>(states_.size()));
    if (fresh) states_.push_back(&at->first), next_.emplace_back();
    return at->second;
  }

  // Strongly connected components [Tarjan, SIAM J. Comput. 1, 1972], without recursion: the number
  // of each state's component.
  std::vector<int> components() const {
    const auto n = states_.size();
    std::vector<int> number(n, -1), low(n, 0), component(n, -1), stack;
    std::vector<std::pair<int, std::size_t>> path;  // a state, and how many of its edges are done
    int visited = 0, found = 0;
    for (std::size_t root = 0; root < n; ++root) {
      if (number[root] >= 0) continue;
      path.push_back({static_cast<int>(root), 0});
      while (!path.empty()) {
        const int at = path.back().first;
        const auto k = static_cast<std::size_t>(at);
        if (path.back().second == 0 && number[k] < 0) {
          number[k] = low[k] = visited++;
          stack.push_back(at);
        }
        if (path.back().second < next_[k].size()) {
          const auto to = static_cast<std::size_t>(next_[k][path.back().second++]);
          if (number[to] < 0)
            path.push_back({static_cast<int>(to), 0});
          else if (component[to] < 0)
            low[k] = std::min(low[k], number[to]);
          continue;
        }
        path.pop_back();
        if (!path.empty()) {
          const auto parent = static_cast<std::size_t>(path.back().first);
          low[parent] = std::min(low[parent], low[k]);
        }
        if (low[k] != number[k]) continue;
        for (int member = -1; member != at;) {
          member = stack.back();
          stack.pop_back();
          component[member] = found;
        }
        ++found;
      }
    }
    return component;
  }

  int copies(int state) const {
    int copies = 0;
    for (std::size_t s = 0; s < network_.species.size(); ++s)
      if (network_.species[s].target) copies += (*states_[state])[s];
    return copies;
  }

  const ReactionNetwork& network_;
  std::vector<const Reaction*> reactions_;
  std::int64_t limit_;
  std::unordered_map<Counts, int> index_;  // nodes do not move, so states_ may point into it
  std::vector<const Counts*> states_;
  std::vector<std::vector<int>> next_;
};

}  // namespace

std::vector<EndState> PopulationGraph::deadlocks() const {
  std::vector<EndState> found;
  for (const EndState& end : ends)
    if (end.copies < possible) found.push_back(end);
  return found;
}

PopulationGraph population_graph(const Ruleset& rules, const ReactionNetwork& network, int modules,
                                 std::int64_t limit, const JobControl& control) {
  if (modules < 1 || modules > std::numeric_limits<std::int16_t>::max())
    throw InputError("a population of " + std::to_string(modules) +
                     " modules: expected 1 .. 32767");
  std::vector<const Reaction*> reactions;
  for (const Reaction& reaction : network.reactions)
    if (rules.rules[reaction.rule].p > 0) reactions.push_back(&reaction);
  Graph graph(network, std::move(reactions), limit);
  PopulationGraph result;
  result.complete = graph.explore(modules, control) && network.closed;
  result.states = graph.states();
  if (!rules.target.empty()) result.possible = modules / static_cast<int>(rules.target.size());
  if (result.complete) result.ends = graph.ends();
  return result;
}

int first_irreversible_size(const Ruleset& rules, const ReactionNetwork& network) {
  int least = 0;
  for (std::size_t s = 1; s < network.species.size(); ++s) {
    const bool undone = std::any_of(
        network.reactions.begin(), network.reactions.end(), [&](const Reaction& reaction) {
          return reaction.kind == RuleKind::unlink &&
                 reaction.from.front() == static_cast<int>(s) && rules.rules[reaction.rule].p > 0;
        });
    const int size = network.species[s].size;
    if (!undone && (least == 0 || size < least)) least = size;
  }
  return least;
}

bool deadlock_risk(int modules, int irreversible_size, int target_size) {
  return irreversible_size > 0 && target_size > 0 &&
         modules / irreversible_size > modules / target_size;
}

bool serial_deadlock(int modules, int irreversible_size, int target_size) {
  if (irreversible_size <= 0 || irreversible_size >= target_size) return false;
  for (int copies = 0; copies < modules / target_size; ++copies) {
    const int rest = modules - copies * target_size;
    const int most = rest / irreversible_size;  // assemblies
    if (most > 0 && rest <= most * (target_size - 1)) return true;
  }
  return false;
}

}  // namespace lilytank
