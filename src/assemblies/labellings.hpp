// Ruleset states of the modules of an assembly of which only the cells are known.
#pragma once
#include <map>
#include <vector>

#include "assemblies/pattern.hpp"

namespace lilytank {

/// The assemblies that a ruleset can make of single modules, by their shape.
class Labellings {
 public:
  /// Of up to `largest` modules.
  Labellings(const Ruleset& rules, int largest);
  /// All of them whose modules lie in these cells, each with its modules in the order of the cells;
  /// no two are equal. Empty if the rules make no assembly of this shape.
  std::vector<Pattern> of(const std::vector<Cell>& cells) const;

 private:
  std::map<std::vector<Cell>, std::vector<Pattern>> by_shape_;  // canonical shapes
};

}  // namespace lilytank
