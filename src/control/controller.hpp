// What a module does when it meets another: latch, exchange labels, decide, release.
#pragma once
#include <vector>

#include "lilytank/world.hpp"
#include "physics/assembly.hpp"
#include "physics/motion.hpp"

namespace lilytank {

/// Runs all modules' firmware and the base station's commands once a tick (25 ms).
class Controller {
 public:
  explicit Controller(const Model& model);
  /// One tick: commands that are due, docking, exchange by the model's clock, faces that come on
  /// again. Changes `state` and `assemblies`, appends to `events`, adds to `tallies`.
  void tick(State& state, Assemblies& assemblies, Motion& motion, std::vector<Event>& events,
            Tallies& tallies);

 private:
  const Model* model_;
  std::vector<std::uint8_t> peer_;  ///< [4 * modules] a face of a neighbour is in reach
};

}  // namespace lilytank
