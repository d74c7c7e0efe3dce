// Makes room after a latch pulled two assemblies onto one lattice.
#pragma once
#include <vector>

#include "island_builder.hpp"
#include "neighbours.hpp"

namespace lilytank {

/// Pushes assemblies apart, positions only. Holds scratch memory, nothing from call to call.
class Settling {
 public:
  explicit Settling(const Model& model);

  /// Pushes the assembly in `slot`, and what gets in its way in turn, apart. Returns false if an
  /// overlap stays; the builder's island then holds poses of no use. The state is not touched.
  bool make_room(const Assemblies& assemblies, int slot, IslandBuilder& builder);

 private:
  void search(const Assemblies& assemblies, const IslandBuilder& builder);
  void pair_body(int i, int k, IslandBuilder& builder) const;

  const Model* model_;
  Neighbours neighbours_;
  std::vector<double> x_, y_;  // m, centres of all bodies as the island has them
};

}  // namespace lilytank
