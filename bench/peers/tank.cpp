#include "tank.hpp"

#include <algorithm>

namespace lilytank::bench {

PeerTank::PeerTank(const Model& model, const EngineKind& kind, const State& start, Forces forces,
                   int substeps)
    : model_(model),
      bodies_(model.module.count),
      wrenches_(model.module.count),
      engine_(kind.make({model, start, substeps})),
      seed_(start.seed) {
  if (forces == Forces::plain) plain_.emplace(model, seed_);
  engine_->read(bodies_);
}

void PeerTank::step() {
  if (plain_) {
    plain_->compute(bodies_, wrenches_);
  } else {
    add_library_forces();
  }
  engine_->step(wrenches_);
  engine_->read(bodies_);
  ++steps_;
}

void PeerTank::add_library_forces() {
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  const StepContext now{static_cast<double>(steps_) * kTick, steps_, steps_, seed_};
  for (const ActiveForce& force : model_.forces)
    force.term->add(model_, bodies_.kinematics(), now, force.p, wrenches_);
}

}  // namespace lilytank::bench
