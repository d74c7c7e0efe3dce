// Orders of joins on a tree given as neighbour lists; what the algorithms are made of.
#pragma once
#include <vector>

#include "lilytank/target.hpp"

namespace lilytank {

using Neighbours = std::vector<std::vector<int>>;

/// Leaves from which growth may begin: those at an end of the tree without its leaves.
std::vector<int> end_leaves(const Neighbours& tree);
/// One module at a time from a leaf: at every module first its other leaves, then its inner
/// neighbours, each in the lists' order; then on from every inner neighbour.
std::vector<Contact> growth_from(const Neighbours& tree, int leaf);
/// Indices of the edges that cut the tree into the most equal parts.
std::vector<int> most_equal_edges(const Neighbours& tree, const std::vector<Contact>& edges);
/// Both parts grow from their far ends towards the edge, every module taking its far neighbours in
/// the lists' order; the edge is joined last.
std::vector<Contact> linchpin_order(const Neighbours& tree, const Contact& edge);
/// Split at the first of the most equal edges, each part again, then joined.
std::vector<Contact> balanced_order(int nodes, const std::vector<Contact>& edges);
/// The joins in the same order, each turned so that `a` is in the larger part at that time; of two
/// equal parts as given.
std::vector<Contact> larger_part_first(int nodes, std::vector<Contact> joins);

}  // namespace lilytank
