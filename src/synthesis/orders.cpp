#include "synthesis/orders.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "synthesis/tree.hpp"

namespace lilytank {
namespace {

bool is_leaf(const Neighbours& tree, int node) {
  return tree[node].size() == 1;
}

int inner_neighbours(const Neighbours& tree, int node) {
  const auto& list = tree[node];
  return static_cast<int>(
      std::count_if(list.begin(), list.end(), [&](int other) { return !is_leaf(tree, other); }));
}

void grow(const Neighbours& tree, int node, int from, std::vector<Contact>& joins) {
  std::vector<int> inner;
  for (const bool leaves : {true, false}) {
    for (const int other : tree[node]) {
      if (other == from || is_leaf(tree, other) != leaves) continue;
      joins.push_back({node, other});
      if (!leaves) inner.push_back(other);
    }
  }
  for (const int other : inner) grow(tree, other, node, joins);
}

void gather(const Neighbours& tree, int node, int parent, std::vector<Contact>& joins) {
  for (const int other : tree[node]) {
    if (other == parent) continue;
    gather(tree, other, node, joins);
    joins.push_back({node, other});
  }
}

}  // namespace

std::vector<int> end_leaves(const Neighbours& tree) {
  std::vector<int> found;
  for (int node = 0; node < static_cast<int>(tree.size()); ++node) {
    if (!is_leaf(tree, node)) continue;
    if (inner_neighbours(tree, tree[node].front()) <= 1) found.push_back(node);
  }
  return found;
}

std::vector<Contact> growth_from(const Neighbours& tree, int leaf) {
  const int parent = tree[leaf].front();
  std::vector<Contact> joins = {{parent, leaf}};
  grow(tree, parent, leaf, joins);
  return joins;
}

std::vector<int> most_equal_edges(const Neighbours& tree, const std::vector<Contact>& edges) {
  const int nodes = static_cast<int>(edges.size()) + 1;
  std::vector<int> found;
  int least = std::numeric_limits<int>::max();
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const int part = static_cast<int>(side_of(tree, edges[k].a, edges[k].b).size());
    const int difference = std::abs(nodes - 2 * part);
    if (difference < least) found.clear(), least = difference;
    if (difference == least) found.push_back(static_cast<int>(k));
  }
  return found;
}

std::vector<Contact> linchpin_order(const Neighbours& tree, const Contact& edge) {
  std::vector<Contact> joins;
  gather(tree, edge.a, edge.b, joins);
  gather(tree, edge.b, edge.a, joins);
  joins.push_back(edge);
  return larger_part_first(static_cast<int>(tree.size()), std::move(joins));
}

std::vector<Contact> larger_part_first(int nodes, std::vector<Contact> joins) {
  Parts parts(nodes);
  for (Contact& join : joins) {
    if (parts.size(join.b) > parts.size(join.a)) std::swap(join.a, join.b);
    parts.join(join.a, join.b);
  }
  return joins;
}

std::vector<Contact> balanced_order(int nodes, const std::vector<Contact>& edges) {
  if (edges.empty()) return {};
  const auto tree = neighbours_of(nodes, edges);
  const Contact cut = edges[most_equal_edges(tree, edges).front()];
  std::vector<Contact> joins;
  for (const auto& [near, far] : {std::pair{cut.a, cut.b}, std::pair{cut.b, cut.a}}) {
    const std::vector<int> part = side_of(tree, near, far);
    std::vector<Contact> inside;
    for (const Contact& edge : edges) {
      const auto in = [&](int node) {
        return std::find(part.begin(), part.end(), node) != part.end();
      };
      if (in(edge.a) && in(edge.b)) inside.push_back(edge);
    }
    const std::vector<Contact> made = balanced_order(nodes, inside);
    joins.insert(joins.end(), made.begin(), made.end());
  }
  joins.push_back(cut);
  return larger_part_first(nodes, std::move(joins));
}

}  // namespace lilytank
