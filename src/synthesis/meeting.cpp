#include "synthesis/meeting.hpp"

#include "synthesis/steric.hpp"

namespace lilytank {

void set_bond(Pattern& pattern, std::size_t a, std::size_t b, int direction, bool bonded) {
  const unsigned bit_a = 1u << (direction & 3), bit_b = 1u << ((direction + 2) & 3);
  if (bonded)
    pattern[a].bonds |= bit_a, pattern[b].bonds |= bit_b;
  else
    pattern[a].bonds &= ~bit_a, pattern[b].bonds &= ~bit_b;
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

bool free_to_meet(const Pattern& whole, std::size_t host, const Site& ours) {
  std::vector<Cell> cells[2];
  for (std::size_t k = 0; k < whole.size(); ++k) cells[k < host ? 0 : 1].push_back(whole[k].cell);
  return can_approach(cells[0], cells[1], whole[ours.module].cell, ours.direction);
}

}  // namespace lilytank
