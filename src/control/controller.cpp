#include "control/controller.hpp"

namespace lilytank {

Controller::Controller(const Model& model)
    : model_(&model), base_station_(model), docking_(model), exchange_(model) {}

void Controller::tick(State& state, Assemblies& assemblies, Bodies& bodies, Motion& motion,
                      Movers& movers, std::vector<Event>& events, Tallies& tallies) {
  Tick now{*model_, state,   assemblies,
           bodies,  motion,  movers,
           events,  tallies, state.step / model_->steps_per_tick};
  base_station_.speak(now);
  if (model_->control.latches) docking_.run(now);
  exchange_.run(now);
}

}  // namespace lilytank
