#include <sys/time.h>

#include "engine.hpp"
#include "proof/box2d_bodies.hpp"

// Box2D asks for the time around every island, for a profile that nobody reads here; that costs a
// quarter of its time. In this program the clock it asks stands still. (Speeds are measured by
// another clock.)
extern "C" int gettimeofday(struct timeval* now, void*) noexcept {
  *now = {};
  return 0;
}

namespace lilytank::bench {
namespace {

// Such that a step leaves what the simulator's leaves.
Box2dBodies::Damping damping_of(const EngineSetup& setup) {
  const Decay decay = setup.decay();
  return {(1 / decay.linear - 1) / setup.step(), (1 / decay.angular - 1) / setup.step()};
}

class Box2d final : public Engine {
 public:
  explicit Box2d(const EngineSetup& setup)
      : bodies_(setup.model, setup.start, setup.model.tank.radius + Box2dBodies::kSkin,
                wall_corners(setup.model.tank.radius), damping_of(setup)),
        step_(setup.step()),
        substeps_(setup.substeps) {
    bodies_.world().SetContinuousPhysics(false);  // slower, and only walls would need it
    bodies_.world().SetAutoClearForces(false);
  }

  void read(Bodies& out) const override { bodies_.read(out); }

  void step(std::span<const Wrench> wrenches) override {
    bodies_.push(wrenches);
    for (int k = 0; k < substeps_; ++k) bodies_.step(step_);
    bodies_.world().ClearForces();
  }

 private:
  Box2dBodies bodies_;
  double step_;
  int substeps_;
};

}  // namespace

std::unique_ptr<Engine> make_box2d(const EngineSetup& setup) {
  return std::make_unique<Box2d>(setup);
}

}  // namespace lilytank::bench
