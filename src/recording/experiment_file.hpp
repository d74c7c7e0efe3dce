// [experiment] and [[recording]] tables of an experiment file.
#pragma once
#include <string>
#include <vector>

#include "io/scenario_layers.hpp"
#include "lilytank/experiment.hpp"

namespace lilytank {

/// Name and sources of an experiment whose base is known; nothing is read. Keys of [experiment]
/// other than its name hold for all recordings that do not say otherwise. Throws InputError.
void read_experiment_tables(const std::vector<Layer>& layers, Experiment& experiment);

/// Sets the tank's radius and the body's from what the model says of bodies of the options' kind.
void take_sizes(const Model& model, RecordingOptions& options);

}  // namespace lilytank
