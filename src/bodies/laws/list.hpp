// Every law of the library, by its own function.
#pragma once
#include "bodies/law.hpp"

namespace lilytank::bodies {

const Law& gravity();
const Law& pendulum();
const Law& constant_force();
const Law& linear_drag();
const Law& quadratic_drag();
const Law& dry_friction();
const Law& linear_spring();
const Law& cubic_spring();
const Law& pair_power_law();
const Law& pair_dipoles();
const Law& pair_exponential();
const Law& pair_spring();
const Law& coriolis();
const Law& rotation();
const Law& tide_turning();
const Law& driver_force();
const Law& curve_of_slip();
const Law& curve_of_position();
const Law& curve_of_gap();
const Law& curve_of_time();

}  // namespace lilytank::bodies
