#include "synthesis/tree.hpp"

#include <algorithm>
#include <numeric>

#include "lilytank/synthesis.hpp"

namespace lilytank {
namespace {

std::vector<Contact> edges_of(const Target& target) {
  return target.bonds.empty() ? contacts_of(target) : target.bonds;
}

}  // namespace

std::vector<std::vector<int>> neighbours_of(int nodes, const std::vector<Contact>& edges) {
  std::vector<std::vector<int>> found(static_cast<std::size_t>(nodes));
  for (const Contact& edge : edges) {
    found[edge.a].push_back(edge.b);
    found[edge.b].push_back(edge.a);
  }
  for (std::vector<int>& list : found) std::sort(list.begin(), list.end());
  return found;
}

Parts::Parts(int nodes)
    : parent_(static_cast<std::size_t>(nodes)), size_(static_cast<std::size_t>(nodes), 1) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

int Parts::find(int node) {
  while (parent_[node] != node) node = parent_[node];
  return node;
}

bool Parts::join(int a, int b) {
  a = find(a), b = find(b);
  if (a == b) return false;
  if (size_[a] < size_[b]) std::swap(a, b);
  parent_[b] = a;
  size_[a] += size_[b];
  return true;
}

std::vector<int> Parts::members(int node) {
  std::vector<int> found;
  const int root = find(node);
  for (int k = 0; k < static_cast<int>(parent_.size()); ++k)
    if (find(k) == root) found.push_back(k);
  return found;
}

bool hangs_together(int nodes, const std::vector<Contact>& edges) {
  Parts parts(nodes);
  int pieces = nodes;
  for (const Contact& edge : edges) pieces -= parts.join(edge.a, edge.b) ? 1 : 0;
  return pieces == 1;
}

std::vector<int> side_of(const std::vector<std::vector<int>>& tree, int from, int across) {
  std::vector<int> found = {from};
  std::vector<bool> seen(tree.size(), false);
  seen[from] = seen[across] = true;
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (const int next : tree[found[k]]) {
      if (seen[next]) continue;
      seen[next] = true;
      found.push_back(next);
    }
  }
  return found;
}

std::vector<Contact> spanning_tree(const Target& target) {
  const int nodes = static_cast<int>(target.cells.size());
  const auto next_to = neighbours_of(nodes, edges_of(target));
  std::vector<Contact> tree;
  std::vector<bool> seen(target.cells.size(), false);
  std::vector<int> queue = {0};
  seen[0] = true;
  for (std::size_t k = 0; k < queue.size(); ++k) {
    for (const int other : next_to[queue[k]]) {
      if (seen[other]) continue;
      seen[other] = true;
      queue.push_back(other);
      tree.push_back({std::min(queue[k], other), std::max(queue[k], other)});
    }
  }
  std::sort(tree.begin(), tree.end());
  return tree;
}

std::vector<std::vector<Contact>> spanning_trees(const Target& target, std::size_t limit) {
  const int nodes = static_cast<int>(target.cells.size());
  std::vector<Contact> edges = edges_of(target);
  std::sort(edges.begin(), edges.end());
  std::vector<std::vector<Contact>> trees;
  std::vector<Contact> chosen;
  // Takes or leaves edge k; leaves it only if the rest can still hold everything together.
  const auto grow = [&](const auto& self, std::size_t k, const Parts& parts) -> void {
    if (trees.size() >= limit) return;
    if (static_cast<int>(chosen.size()) == nodes - 1) return trees.push_back(chosen);
    Parts with = parts;
    if (with.join(edges[k].a, edges[k].b)) {
      chosen.push_back(edges[k]);
      self(self, k + 1, with);
      chosen.pop_back();
      std::vector<Contact> possible = chosen;
      possible.insert(possible.end(), edges.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                      edges.end());
      if (!hangs_together(nodes, possible)) return;
    }
    self(self, k + 1, parts);
  };
  grow(grow, 0, Parts(nodes));
  return trees;
}

bool is_caterpillar(int cells, const std::vector<Contact>& tree) {
  const auto next_to = neighbours_of(cells, tree);
  for (const std::vector<int>& list : next_to) {
    const auto inner = std::count_if(list.begin(), list.end(),
                                     [&](int other) { return next_to[other].size() > 1; });
    if (list.size() > 1 && inner > 2) return false;
  }
  return true;
}

}  // namespace lilytank
