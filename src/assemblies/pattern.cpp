#include "assemblies/pattern.hpp"

#include <algorithm>
#include <charconv>

namespace lilytank {

Pattern turned(Pattern pattern) {
  for (PatternModule& module : pattern) {
    module.cell = {-module.cell.y, module.cell.x};
    if (module.last >= 0) module.last = (module.last + 1) & 3;
    module.bonds = ((module.bonds << 1) | (module.bonds >> 3)) & 15u;
  }
  return pattern;
}

Pattern canonical(const Pattern& pattern) {
  Pattern best, turning = pattern;
  for (int turn = 0; turn < 4; ++turn) {
    Pattern moved = turning;
    Cell low = moved.front().cell;
    for (const PatternModule& m : moved)
      low = {std::min(low.x, m.cell.x), std::min(low.y, m.cell.y)};
    for (PatternModule& m : moved) m.cell = {m.cell.x - low.x, m.cell.y - low.y};
    std::sort(moved.begin(), moved.end());
    if (best.empty() || moved < best) best = std::move(moved);
    turning = turned(std::move(turning));
  }
  return best;
}

std::string key_of(const Pattern& canonical) {
  std::string key;
  for (const PatternModule& m : canonical) {
    if (!key.empty()) key += ';';
    for (const int value : {m.cell.x, m.cell.y, m.label, m.last, static_cast<int>(m.bonds)}) {
      if (!key.empty() && key.back() != ';') key += ',';
      key += std::to_string(value);
    }
  }
  return key;
}

Pattern pattern_of(const std::string& key) {
  Pattern pattern;
  const char* at = key.data();
  const char* const end = key.data() + key.size();
  while (at < end) {
    int value[5] = {0, 0, 0, -1, 0};
    for (int& v : value) {
      at = std::from_chars(at, end, v).ptr;
      if (at < end) ++at;  // ',' or ';'
    }
    pattern.push_back(
        {{value[0], value[1]}, value[2], value[3], static_cast<unsigned>(value[4]) & 15u});
  }
  return pattern;
}

Species species_of(const Pattern& canonical, const std::vector<Cell>& target) {
  Species species;
  species.key = key_of(canonical);
  species.size = static_cast<int>(canonical.size());
  Cell high;
  std::vector<Cell> cells;
  for (const PatternModule& m : canonical) {
    high = {std::max(high.x, m.cell.x), std::max(high.y, m.cell.y)};
    cells.push_back(m.cell);
  }
  species.target = !target.empty() && canonical_shape(cells) == target;
  for (int y = high.y; y >= 0; --y) {
    std::string row(static_cast<std::size_t>(high.x + 1), '.');
    for (const Cell& cell : cells)
      if (cell.y == y) row[static_cast<std::size_t>(cell.x)] = '#';
    species.drawing += (species.drawing.empty() ? "" : "/") + row;
  }
  return species;
}

}  // namespace lilytank
