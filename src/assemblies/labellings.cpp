#include "assemblies/labellings.hpp"

#include <algorithm>

namespace lilytank {
namespace {

std::vector<Cell> cells_of(const Pattern& pattern) {
  std::vector<Cell> cells;
  for (const PatternModule& module : pattern) cells.push_back(module.cell);
  return cells;
}

Cell lowest(const std::vector<Cell>& cells) {
  Cell low = cells.front();
  for (const Cell& c : cells) low = {std::min(low.x, c.x), std::min(low.y, c.y)};
  return low;
}

// The pattern moved onto the cells, in their order; empty where it does not fit.
Pattern laid_on(const std::vector<Cell>& cells, const Pattern& pattern) {
  const Cell to = lowest(cells), from = lowest(cells_of(pattern));
  Pattern out;
  for (const Cell& cell : cells) {
    const std::size_t k = module_at(pattern, {cell.x - to.x + from.x, cell.y - to.y + from.y});
    if (k == pattern.size()) return {};
    out.push_back(pattern[k]);
    out.back().cell = cell;
  }
  return out;
}

}  // namespace

Labellings::Labellings(const Ruleset& rules, int largest) {
  for (const Species& species : reachable_species(rules, kMostSpecies, largest).species) {
    Pattern pattern = pattern_of(species.key);
    by_shape_[canonical_shape(cells_of(pattern))].push_back(std::move(pattern));
  }
}

std::vector<Pattern> Labellings::of(const std::vector<Cell>& cells) const {
  std::vector<Pattern> out;
  const auto found = by_shape_.find(canonical_shape(cells));
  if (found == by_shape_.end()) return out;
  for (Pattern pattern : found->second) {
    for (int turn = 0; turn < 4; ++turn) {
      Pattern laid = laid_on(cells, pattern);
      if (!laid.empty()) out.push_back(std::move(laid));
      pattern = turned(std::move(pattern));
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace lilytank
