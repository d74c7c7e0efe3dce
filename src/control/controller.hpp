// What a module does when it meets another: latch, exchange labels, decide, release.
#pragma once
#include <vector>

#include "control/base_station.hpp"
#include "control/docking.hpp"
#include "control/exchange.hpp"

namespace lilytank {

/// Runs all modules' firmware and the base station's commands once a tick (25 ms).
class Controller {
 public:
  explicit Controller(const Model& model);
  /// One tick: commands that are due, faces that come on again, docking, exchange by the model's
  /// clock. Changes `state`, `assemblies` and `bodies`, appends to `events`, adds to `tallies`.
  void tick(State& state, Assemblies& assemblies, Bodies& bodies, Motion& motion, Movers& movers,
            std::vector<Event>& events, Tallies& tallies);

 private:
  const Model* model_;
  BaseStation base_station_;
  Docking docking_;
  Exchange exchange_;
};

}  // namespace lilytank
