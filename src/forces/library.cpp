#include "library.hpp"

#include <array>

#include "float_bodies.hpp"
#include "lilytank/model.hpp"

namespace lilytank {

std::span<const ForceTerm* const> force_library() {
  // The order of addition is part of every result: new terms go to the end.
  static const std::array terms{&face_drag(),
                                &ball_drag(),
                                &stochastic_force(),
                                &damping(),
                                &body_force(),
                                &pair_attraction(),
                                &pair_repulsion(),
                                &magnetic_dipole(),
                                &latch_stick(),
                                &lubrication(),
                                &wake_shielding(),
                                &wall_force(),
                                &wall_layer(),
                                &magnus_lift(),
                                &viscous_drag(),
                                &rotational_drag(),
                                &coriolis(),
                                &flow_pulsation(),
                                &flow_drift(),
                                &local_flow(),
                                &correlated_gusts(),
                                &vortex_shedding(),
                                &self_propulsion(),
                                &spin_torque(),
                                &state_dependent_noise(),
                                &heavy_tailed_kicks(),
                                &added_mass(),
                                &heterogeneous_module(),
                                &mass_offset(),
                                &empirical_force(),
                                &drag_patch()};
  return terms;
}

std::unique_ptr<LaneForce> ForceTerm::in_lanes(const Model&, std::span<const double>) const {
  return nullptr;
}

const FlowField& field_now(const Model& model, const StepContext& now) {
  return now.field != nullptr ? *now.field : *model.field;
}

const ForceTerm* find_force(std::string_view name) {
  for (const ForceTerm* term : force_library()) {
    if (term->name() == name) return term;
  }
  return nullptr;
}

ActiveForce with_defaults(const ForceTerm& term) {
  ActiveForce force{&term, {}};
  for (const Parameter& p : term.parameters()) force.p.push_back(p.standard);
  return force;
}

}  // namespace lilytank
