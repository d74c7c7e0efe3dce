// Moves assemblies over one step without letting anything overlap, tunnel or leave the tank.
#pragma once
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "assembly.hpp"
#include "lilytank/event.hpp"
#include "lilytank/state.hpp"

namespace lilytank {

/// No two bodies, and no body and the wall, overlap by more than this after a step, m.
constexpr double kOverlapLimit = 0.5e-3;

/// The most visits of contacts and pairs in one step: about ten seconds. A full tank of 2000
/// modules takes a fortieth of it.
constexpr std::int64_t kMostWork = 400'000'000;

/// The contact solver with its scratch memory.
class Motion {
 public:
  explicit Motion(const Model& model, std::int64_t most_work = kMostWork);
  ~Motion();
  Motion(Motion&&) noexcept;

  /// Solves contacts for the velocities in `state`, then moves every assembly by dt. On entry
  /// the poses in `assemblies` must be those of `state` (its twists may be older); on return poses
  /// and twists in both are those at the end of the step. Deterministic; keeps nothing from call to
  /// call but near_pairs()'s search. A state in which something moves at more than 100 m/s, or is
  /// not finite, is left alone.
  ///
  /// Returns -1, or a slot of the island whose contacts took the step's work beyond `most_work`:
  /// then bodies stay where they were before the step, or before the slice of it that took so much.
  int advance(State& state, Assemblies& assemblies, Tallies& tallies);

  /// Pushes the assembly in `slot` and what it touches apart until no overlap exceeds a fraction
  /// of kOverlapLimit, changing positions only. Returns false and leaves `state` as it was where
  /// that fails, or once latches took a quarter of the step's work. Used after a latch pulled two
  /// modules onto their lattice.
  bool settle(State& state, Assemblies& assemblies, int slot);

  /// Pairs (i < j, ascending) of modules whose centres are closer than `distance`, for latches.
  /// The span is valid until the next call. The search serves advance() as well, so poses must not
  /// change in between other than by settle().
  std::span<const std::pair<int, int>> near_pairs(const Assemblies& assemblies, double distance);
  /// Forgets the search: poses are others.
  void forget();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Greatest overlap of any two bodies of different assemblies, or of a body with the wall, m
/// (0 if nothing overlaps). Independent of the solver; for tests and checks.
double deepest_overlap(const Model& model, const Assemblies& assemblies);
/// The same with the bodies that it is between.
Overlap deepest_pair(const Model& model, const Assemblies& assemblies);

}  // namespace lilytank
