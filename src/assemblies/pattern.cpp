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

void apply(const Rule& rule, std::size_t order, Pattern& pattern, std::size_t a, std::size_t b,
           int direction) {
  const auto engage = [&](PatternModule& module, int towards, const Label& after) {
    module.label = after.state;
    module.last = last_after(towards & 3, after.hop);
    const unsigned bond = 1u << (towards & 3);
    if (rule.kind == RuleKind::link) module.bonds |= bond;
    if (rule.kind == RuleKind::unlink) module.bonds &= ~bond;
  };
  engage(pattern[a], direction, rule.after[order]);
  engage(pattern[b], direction + 2, rule.after[1 - order]);
}

std::size_t module_at(const Pattern& pattern, Cell cell) {
  std::size_t k = 0;
  while (k < pattern.size() && pattern[k].cell != cell) ++k;
  return k;
}

std::vector<Site> free_sites(const Pattern& pattern) {
  std::vector<Site> sites;
  for (std::size_t k = 0; k < pattern.size(); ++k)
    for (int d = 0; d < 4; ++d)
      if (module_at(pattern, neighbour(pattern[k].cell, d)) == pattern.size())
        sites.push_back({k, d});
  return sites;
}

std::vector<Pattern> parts_of(const Pattern& pattern) {
  std::vector<Pattern> parts;
  std::vector<bool> done(pattern.size(), false);
  for (std::size_t first = 0; first < pattern.size(); ++first) {
    if (done[first]) continue;
    std::vector<std::size_t> members = {first};
    done[first] = true;
    Pattern part;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const PatternModule& module = pattern[members[k]];
      part.push_back(module);
      for (int d = 0; d < 4; ++d) {
        if ((module.bonds >> d & 1u) == 0) continue;
        const std::size_t n = module_at(pattern, neighbour(module.cell, d));
        if (n < pattern.size() && !done[n]) done[n] = true, members.push_back(n);
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

std::optional<Pattern> beside(const Pattern& host, const Site& ours, const Pattern& guest,
                              const Site& theirs) {
  Pattern whole = host, added = guest;
  for (int turns = (ours.direction + 2 - theirs.direction) & 3; turns > 0; --turns)
    added = turned(std::move(added));
  const Cell to = neighbour(host[ours.module].cell, ours.direction);
  const Cell from = added[theirs.module].cell;
  for (PatternModule& module : added) {
    module.cell = {module.cell.x - from.x + to.x, module.cell.y - from.y + to.y};
    if (module_at(host, module.cell) < host.size()) return std::nullopt;
    whole.push_back(module);
  }
  return whole;
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
      if (cell.y == y) row[cell.x] = '#';
    species.drawing += (species.drawing.empty() ? "" : "/") + row;
  }
  return species;
}

}  // namespace lilytank
