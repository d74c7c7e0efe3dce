#include "island_stepper.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank::reference {
namespace {

constexpr double kReach = 1.25;        // contacts are looked for in so many times the closing way
constexpr double kReachSpare = 1e-4;   // m
constexpr double kUndoLimit = 4.5e-4;  // m, below kOverlapLimit by more than rounding
constexpr int kPushRounds = 40;        // sweeps that push overlaps apart after a substep

// Pushes overlaps apart and puts back what that does not help. A start that was worse than the
// limit (poses given by a user) may only get better. Returns the deepest overlap, m.
double keep_good(Island& island, double deepest, double before, Tallies& tallies) {
  if (deepest > kSlop) {
    island.push_apart(kPushRounds);
    deepest = island.survey();
  }
  const double limit = std::max(kUndoLimit, before);
  if (deepest > limit || island.any_beyond_bound()) {
    tallies.moves_undone += island.put_back(limit);
    deepest = island.survey();
  }
  return deepest;
}

}  // namespace

void IslandStepper::run(Island& island, double h, std::int64_t most_work, Tallies& tallies) {
  double deepest = island.survey();
  if (deepest > kSlop) deepest = keep_good(island, deepest, deepest, tallies);
  island.accept(0);
  for (double left = h; left > 0 && island.work <= most_work;) {
    const StepLimits limits = island.step_limits(left);
    const double part =
        limits.longest < left ? left / (std::floor(left / limits.longest) + 1) : left;
    const bool free = limits.free_time >= part;
    const double step = free ? std::min(limits.free_time, left) : part;
    const double margin = kReach * limits.fastest * step + kReachSpare;
    const bool met = !free && solver_.approach(island, margin, step);
    island.move(step);
    if (met) solver_.rebound(island, step);
    left = step < left ? left - step : 0;
    deepest = keep_good(island, island.survey(), deepest, tallies);
    island.accept(h - left);
  }
  tallies.deepest_overlap = std::max(tallies.deepest_overlap, deepest);
}

}  // namespace lilytank::reference
