// The terms that library.cpp lists; each is defined in the file of its name.
#pragma once
#include "lilytank/force.hpp"

namespace lilytank {

const ForceTerm& face_drag();
const ForceTerm& ball_drag();
const ForceTerm& stochastic_force();
const ForceTerm& damping();
const ForceTerm& body_force();
const ForceTerm& pair_attraction();
const ForceTerm& pair_repulsion();
const ForceTerm& magnetic_dipole();
const ForceTerm& latch_stick();
const ForceTerm& lubrication();
const ForceTerm& wake_shielding();
const ForceTerm& wall_force();
const ForceTerm& wall_layer();
const ForceTerm& magnus_lift();
const ForceTerm& viscous_drag();
const ForceTerm& rotational_drag();
const ForceTerm& coriolis();
const ForceTerm& flow_pulsation();
const ForceTerm& flow_drift();
const ForceTerm& local_flow();
const ForceTerm& correlated_gusts();
const ForceTerm& vortex_shedding();
const ForceTerm& self_propulsion();
const ForceTerm& spin_torque();
const ForceTerm& state_dependent_noise();
const ForceTerm& heavy_tailed_kicks();
const ForceTerm& added_mass();
const ForceTerm& heterogeneous_module();
const ForceTerm& mass_offset();
const ForceTerm& empirical_force();
const ForceTerm& drag_patch();

}  // namespace lilytank
