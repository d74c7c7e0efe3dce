// A tank on another engine: forces from outside, rigid bodies from the engine.
#pragma once
#include <optional>

#include "engine.hpp"
#include "plain_forces.hpp"

namespace lilytank::bench {

enum class Forces {
  plain,    ///< PlainForces
  library,  ///< the model's own terms: then only the engine differs from a World
};

class PeerTank {
 public:
  /// `model` must outlive the tank.
  PeerTank(const Model& model, const EngineKind& kind, const State& start, Forces forces,
           int substeps);
  /// Advances by kTick.
  void step();
  const Bodies& bodies() const { return bodies_; }

 private:
  void add_library_forces();
  const Model& model_;
  Bodies bodies_;
  std::vector<Wrench> wrenches_;
  std::unique_ptr<Engine> engine_;
  std::optional<PlainForces> plain_;
  std::uint64_t seed_;
  std::int64_t steps_ = 0;
};

}  // namespace lilytank::bench
