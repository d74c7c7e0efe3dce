// What the base station says to the modules by radio.
#pragma once
#include "control/tick.hpp"

namespace lilytank {

/// Carries out the model's commands that are due in this tick, in their order.
void obey_base_station(Tick& tick);

}  // namespace lilytank
