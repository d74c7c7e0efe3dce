// Moves the bodies of many worlds over one step without letting anything overlap, tunnel or leave
// the tank.
#pragma once
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "assembly.hpp"
#include "bodies.hpp"
#include "lilytank/event.hpp"
#include "lilytank/state.hpp"

namespace lilytank {

/// No two bodies, and no body and the wall, overlap by more than this after a step, m.
constexpr double kOverlapLimit = 0.5e-3;

/// The most visits of contacts and pairs in one step: about ten seconds. A full tank of 2000
/// modules takes a fortieth of it.
constexpr std::int64_t kMostWork = 400'000'000;

/// One world's part of the motion, with its scratch memory.
class Motion {
 public:
  explicit Motion(const Model& model, std::int64_t most_work = kMostWork);
  ~Motion();
  Motion(Motion&&) noexcept;

  /// Pairs (i < j, ascending) of modules with centres closer than `distance` (m), for latches;
  /// a pair that misses it by a few micrometres may be among them. Valid until the next call.
  std::span<const std::pair<int, int>> near_pairs(const Bodies& bodies, double distance);
  /// Forgets the search: poses are others.
  void forget();

  struct Impl;

 private:
  friend class Movers;
  std::unique_ptr<Impl> impl_;
};

/// A world on its way through a step.
struct InMotion {
  Motion* motion;
  Bodies* bodies;
  const Assemblies* assemblies;
  Tallies* tallies;
  float linear = 0, angular = 0;  ///< shares of the twists lost at the end of the step
  /// Result: -1, or a slot of the island that took more work than allowed. The bodies
  /// then stay where they were before the step, or before the slice of it that took so much.
  int stalled = -1;
};

/// Moves worlds side by side. Holds scratch memory, nothing from call to call.
class Movers {
 public:
  Movers();
  ~Movers();
  Movers(Movers&&) noexcept;
  Movers& operator=(Movers&&) noexcept;

  /// Solves contacts for the velocities of the bodies, then moves everything by dt and damps it. A
  /// world's result depends on nothing but that world. One in which something moves at more than
  /// 100 m/s, or is not finite, is left alone.
  void advance(std::span<InMotion> worlds);

  /// Pushes the assembly in `slot` and what it touches apart until no overlap exceeds a fraction of
  /// kOverlapLimit, changing positions only. Returns false, with poses of no use, where that fails,
  /// or once latches took a quarter of the step's work. Used after a latch pulled two modules onto
  /// their lattice. What is left counts in `tallies`.
  bool settle(Motion& motion, Bodies& bodies, const Assemblies& assemblies, int slot,
              Tallies& tallies);

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
