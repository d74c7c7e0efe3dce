// Two patterns that meet on the lattice, and what rules do to the modules of a pattern.
#pragma once
#include <optional>
#include <vector>

#include "assemblies/pattern.hpp"
#include "lilytank/ruleset.hpp"

namespace lilytank {

/// A face of a module of a pattern.
struct Site {
  std::size_t module = 0;
  int direction = 0;
};

/// What the module would say over its face in `direction` (taken modulo 4).
inline Label label_at(const PatternModule& module, int direction) {
  return {module.label, hop_of(module.last, direction & 3)};
}
/// The state that the right side of a rule gives to a module engaged in `direction`.
inline void relabel(PatternModule& module, int direction, const Label& after) {
  module.label = after.state;
  module.last = last_after(direction & 3, after.hop);
}
/// Makes or ends the bond of a with its neighbour b in `direction`.
void set_bond(Pattern& pattern, std::size_t a, std::size_t b, int direction, bool bonded);
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
/// Whether the modules from index `host` on can come to the others' face `ours` in the plane.
bool free_to_meet(const Pattern& whole, std::size_t host, const Site& ours);

}  // namespace lilytank
