#include "lilytank/ruleset.hpp"

#include <algorithm>

namespace lilytank {

int hop_of(int last, int connector) {
  return last < 0 ? 0 : ((connector - last) & 3) + 1;
}

int last_after(int connector, int hop) {
  return hop == 0 ? -1 : (connector + hop - 1) & 3;
}

int reverse_hop(int hop) {
  return hop == 0 ? 0 : ((1 - hop) & 3) + 1;
}

std::vector<std::array<int, 2>> final_labels(const Ruleset& rules) {
  const auto goes_on = [&](int label) {
    return std::any_of(rules.rules.begin(), rules.rules.end(), [&](const Rule& rule) {
      return rule.kind != RuleKind::unlink &&
             (rule.before[0].state == label || rule.before[1].state == label);
    });
  };
  std::vector<std::array<int, 2>> out;
  for (const Rule& rule : rules.rules) {
    const std::array<int, 2> labels{rule.after[0].state, rule.after[1].state};
    if (rule.kind == RuleKind::link && !goes_on(labels[0]) && !goes_on(labels[1]))
      out.push_back(labels);
  }
  return out;
}

Match match(const Ruleset& rules, Label initiator, Label responder, bool standing, double u) {
  Match found;
  double share = 0;  // of [0,1), taken by the rules before this one
  for (std::size_t k = 0; k < rules.rules.size(); ++k) {
    const Rule& rule = rules.rules[k];
    if ((rule.kind != RuleKind::link) != standing) continue;
    const bool straight = rule.before[0] == initiator && rule.before[1] == responder;
    const bool swapped = rule.before[0] == responder && rule.before[1] == initiator;
    if (!straight && !swapped) continue;
    found.applicable = true;
    share += rule.p;
    // A share of 1 takes all, whatever the rounding of the sum.
    if (u < share || share >= 1) {
      found.rule = static_cast<int>(k);
      found.swapped = !straight;
      return found;
    }
  }
  return found;
}

int possible_copies(const Ruleset& rules, int modules) {
  return rules.target.empty() ? 0 : modules / static_cast<int>(rules.target.size());
}

double docking_share(const Ruleset& rules, const Rule& rule) {
  double sum = 0;
  for (const Rule& other : rules.rules) {
    const bool same = other.before == rule.before ||
                      (other.before[0] == rule.before[1] && other.before[1] == rule.before[0]);
    if (other.kind == RuleKind::link && same) sum += other.p;
  }
  return sum > 0 ? rule.p / sum : 0;
}

std::vector<Cell> canonical_shape(std::vector<Cell> cells) {
  std::vector<Cell> best;
  for (int turn = 0; turn < 4 && !cells.empty(); ++turn) {
    std::vector<Cell> moved = cells;
    Cell low = moved.front();
    for (const Cell& cell : moved) low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
    for (Cell& cell : moved) cell = {cell.x - low.x, cell.y - low.y};
    std::sort(moved.begin(), moved.end());
    if (best.empty() || moved < best) best = std::move(moved);
    for (Cell& cell : cells) cell = {-cell.y, cell.x};
  }
  return best;
}

}  // namespace lilytank
