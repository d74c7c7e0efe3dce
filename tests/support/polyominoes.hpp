// All one-sided polyominoes: shapes that differ by more than a turn; mirror images count apart.
#pragma once
#include <set>
#include <vector>

#include "lilytank/ruleset.hpp"

namespace lilytank::test {

/// Shapes of n cells as canonical_shape gives them; 1, 1, 2, 7, 18, 60, 196 for n = 1 .. 7.
inline std::vector<std::vector<Cell>> one_sided_polyominoes(int n) {
  std::set<std::vector<Cell>> shapes = {canonical_shape({{0, 0}})};
  for (int size = 2; size <= n; ++size) {
    std::set<std::vector<Cell>> larger;
    for (const std::vector<Cell>& shape : shapes) {
      const std::set<Cell> taken(shape.begin(), shape.end());
      for (const Cell& at : shape) {
        for (const Cell& next : {Cell{at.x + 1, at.y}, Cell{at.x - 1, at.y}, Cell{at.x, at.y + 1},
                                 Cell{at.x, at.y - 1}}) {
          if (taken.count(next) > 0) continue;
          std::vector<Cell> grown = shape;
          grown.push_back(next);
          larger.insert(canonical_shape(std::move(grown)));
        }
      }
    }
    shapes = std::move(larger);
  }
  return {shapes.begin(), shapes.end()};
}

}  // namespace lilytank::test
