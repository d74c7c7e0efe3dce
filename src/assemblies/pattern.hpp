// An assembly as rules see it: modules on lattice cells, their states, the bonds between them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "lilytank/assembly_record.hpp"

namespace lilytank {

/// A module of a pattern. Directions count counter-clockwise: 0 = +x, 1 = +y, 2 = -x, 3 = -y.
struct PatternModule {
  Cell cell;
  int label = 0;       ///< l_a
  int last = -1;       ///< direction in which the connector l_n looks, -1: isolated
  unsigned bonds = 0;  ///< bit d: bonded to the neighbour in direction d
  friend bool operator==(const PatternModule&, const PatternModule&) = default;
  friend auto operator<=>(const PatternModule&, const PatternModule&) = default;
};

/// Modules that bonds connect. How a module itself is turned does not matter: rules see connectors
/// only relative to l_n.
using Pattern = std::vector<PatternModule>;

inline Cell neighbour(Cell cell, int direction) {
  constexpr int x[4] = {1, 0, -1, 0}, y[4] = {0, 1, 0, -1};
  return {cell.x + x[direction & 3], cell.y + y[direction & 3]};
}

/// The pattern turned a quarter counter-clockwise.
Pattern turned(Pattern pattern);
/// Moved to the origin, sorted, and the least of its four turns: equal for equal species. Mirror
/// images differ.
Pattern canonical(const Pattern& pattern);
/// A face of a module of a pattern.
struct Site {
  std::size_t module = 0;
  int direction = 0;
};

/// The label that the module shows at its face in `direction` (taken modulo 4).
inline Label label_at(const PatternModule& module, int direction) {
  return {module.label, hop_of(module.last, direction & 3)};
}
/// Whether the left side of a rule is these two labels, the first one being before[order].
inline bool fits(const Rule& rule, std::size_t order, const Label& first, const Label& second) {
  return rule.before[order] == first && rule.before[1 - order] == second;
}
/// Applies a rule to module a, which takes after[order], and its neighbour b in `direction`: their
/// labels, and the bond between them.
void apply(const Rule& rule, std::size_t order, Pattern& pattern, std::size_t a, std::size_t b,
           int direction);
/// Index of the module in a cell, the pattern's size if there is none.
std::size_t module_at(const Pattern& pattern, Cell cell);
/// The faces without a neighbour.
std::vector<Site> free_sites(const Pattern& pattern);
/// What bonds connect, each part a pattern of its own in the same frame.
std::vector<Pattern> parts_of(const Pattern& pattern);
/// The guest turned and moved so that its face `theirs` lies on the host's face `ours`, added to
/// the host; nothing if cells would overlap. No bond is made.
std::optional<Pattern> beside(const Pattern& host, const Site& ours, const Pattern& guest,
                              const Site& theirs);

/// The text of a canonical pattern: "x,y,label,last,bonds" per module, joined by ';'.
std::string key_of(const Pattern& canonical);
/// The pattern of such a text, which must be one of key_of's.
Pattern pattern_of(const std::string& key);
/// The species of a canonical pattern; `target` is a canonical shape, or empty.
Species species_of(const Pattern& canonical, const std::vector<Cell>& target);

/// All species that the rules can make of single modules and of `seeds`, of up to `largest`
/// modules. Stops, with closed = false, at `limit` species.
SpeciesTable species_from(const Ruleset& rules, const std::vector<Pattern>& seeds, int limit,
                          int largest);

}  // namespace lilytank
