// Moves an island through a span of time in substeps.
#pragma once
#include "contact_solver.hpp"
#include "lilytank/event.hpp"
#include "lilytank/state.hpp"

namespace lilytank::reference {

/// Substeps: free flight until something may touch, then contacts; short enough that contact points
/// stay accurate, so as a rule overlaps stay below kSlop. The rest is pushed apart, and what cannot
/// be helped is put back to where it was before the substep: that is what keeps overlaps within
/// kOverlapLimit at any density and speed. It ends, as poses before the substep were good.
class IslandStepper {
 public:
  explicit IslandStepper(const Model& model) : solver_(model) {}
  /// Moves the island by h seconds; adds bodies put back and the deepest overlap to `tallies`.
  /// Gives up once Island::work exceeds `most_work`.
  void run(Island& island, double h, std::int64_t most_work, Tallies& tallies);

 private:
  ContactSolver solver_;
};

}  // namespace lilytank::reference
