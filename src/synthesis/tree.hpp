// Trees over a target's cells: who is next to whom.
#pragma once
#include <utility>
#include <vector>

#include "lilytank/target.hpp"

namespace lilytank {

/// Neighbours of every node, rising; for a target's cells that is raster order.
std::vector<std::vector<int>> neighbours_of(int nodes, const std::vector<Contact>& edges);
/// Whether every node can be reached from every other.
bool hangs_together(int nodes, const std::vector<Contact>& edges);
/// Nodes in one part when the edge between `from` and `across` is cut: those on the side of `from`.
std::vector<int> side_of(const std::vector<std::vector<int>>& tree, int from, int across);

/// Sets that grow together.
class Parts {
 public:
  explicit Parts(int nodes);
  int find(int node);
  /// False if they were one set already.
  bool join(int a, int b);
  int size(int node) { return size_[find(node)]; }
  /// Nodes of the set, rising.
  std::vector<int> members(int node);

 private:
  std::vector<int> parent_, size_;
};

}  // namespace lilytank
