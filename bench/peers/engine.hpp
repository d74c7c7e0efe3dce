// Other engines as they are asked to do the rigid bodies of a tank: squares within a round wall,
// forces given from outside. Only measured against; the simulator uses none of them.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lilytank/model.hpp"
#include "lilytank/state.hpp"

namespace lilytank::bench {

/// Poses and twists of all modules, read from an engine.
struct Bodies {
  explicit Bodies(int count);
  Kinematics kinematics() const;
  std::vector<double> x, y, c, s, vx, vy, omega;
  std::vector<std::uint8_t> covered;  ///< none ever is
};

/// One tank in an engine. Units are SI outside, whatever the engine likes inside.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual void read(Bodies& out) const = 0;
  /// Advances by kTick in `substeps` steps of the engine, under the same wrenches; damping
  /// included.
  virtual void step(std::span<const Wrench> wrenches) = 0;
};

/// What an engine is made from: the sizes, contacts and damping of a model, and where modules
/// start.
struct EngineSetup {
  const Model& model;
  const State& start;
  int substeps = 1;
  double step() const { return kTick / substeps; }  ///< s
  /// Shares of speed and spin that are left after one of the engine's steps.
  Decay decay() const;
};

/// The engines found when this program was built.
struct EngineKind {
  std::string name;
  std::unique_ptr<Engine> (*make)(const EngineSetup& setup);
};
std::vector<EngineKind> engine_kinds();

/// Corners of the polygon that stands for the round wall where an engine knows no ring: one every
/// 15 mm, so that it departs from the circle by 0.1 mm in the paper's tank.
int wall_corners(double radius);

std::unique_ptr<Engine> make_ode(const EngineSetup& setup);
std::unique_ptr<Engine> make_box2d(const EngineSetup& setup);
std::unique_ptr<Engine> make_chipmunk(const EngineSetup& setup);

}  // namespace lilytank::bench
