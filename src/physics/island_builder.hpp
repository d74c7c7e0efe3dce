// Puts assemblies of a State into an Island and finds the geometry of their pairs.
#pragma once
#include <vector>

#include "assembly.hpp"
#include "island.hpp"

namespace lilytank {

/// Fills one island after the other from the same State, which it only reads.
class IslandBuilder {
 public:
  explicit IslandBuilder(const Model& model);

  /// Reads from these until the next call of begin(); the poses in `assemblies` must be up to date.
  void begin(const State& state, const Assemblies& assemblies);

  bool is_module(int body) const { return body < model_->module.count; }
  /// Radius of the circle about a body, m.
  double size_of(int body) const { return is_module(body) ? corner_ : model_->ball.radius; }
  /// The assembly of a body.
  int slot_of(int body) const { return state_->assembly[body]; }
  /// How two bodies lie apart at the start; the normal looks from i to j.
  Gap gap(int i, int j) const;
  /// A body's distance from the wall if it were shifted by (dx, dy), m.
  double wall_gap(int body, double dx, double dy) const;

  /// Forgets the island.
  void clear();
  /// Adds an assembly; `motion_bound` (m) as in Mover.
  void enter(int slot, double motion_bound);
  bool has(int slot) const { return local_[slot] != 0; }
  /// Position of an assembly in slots() plus 1; 0 if it is not in the island.
  int index_of(int slot) const { return local_[slot]; }
  /// The island's assemblies in the order in which they were added.
  const std::vector<int>& slots() const { return slots_; }
  /// Adds a pair of bodies whose assemblies are in the island.
  void link(int i, int j);
  void link_wall(int i);
  /// A body's centre as the island has it now, or where it lies.
  Vec2 centre_of(int body) const;

  Island& island() { return island_; }
  const Island& island() const { return island_; }

 private:
  Square square(int body) const;
  Disc disc(int body) const;
  double place(int body, double& x, double& y) const;

  const Model* model_;
  double corner_, half_;
  const State* state_ = nullptr;
  const Assemblies* assemblies_ = nullptr;
  Island island_;
  std::vector<int> local_, slots_;
};

}  // namespace lilytank
