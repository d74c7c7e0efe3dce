// From layers, wherever they come from, to a Scenario.
#pragma once
#include <vector>

#include "io/scenario_layers.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {

/// What load_scenario does once everything is read. Throws InputError.
Scenario build_scenario(std::vector<Layer> layers);

}  // namespace lilytank
