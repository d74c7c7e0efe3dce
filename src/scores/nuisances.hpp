// What a calibration could absorb: errors of the baseline's parameters and smooth errors of the
// flow, as accelerations of modules. Scores of effects are cleared of them.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "effects/features.hpp"
#include "filter/sensitivity.hpp"
#include "lilytank/flow_maps.hpp"

namespace lilytank {

/// How many there are: factors on drag and on the flow, both dampings, the gusts' strength, alone
/// and growing with the radius, and polynomials of the place, down to a
/// tenth of the tank, for the flow along x and along y.
std::size_t nuisance_count();

/// The acceleration of module `i` by every one at its size, from `first` on.
void push_nuisances(const Features& features, const Kinematics& k, std::size_t i, std::size_t first,
                    Pushes& pushes);

/// What is known of their amplitudes, in sizes, before any recording: the inverse of their
/// covariance, [nuisance, nuisance]. Parameters are hardly known; of the flow what the balls and
/// its further errors (flow_uncertainty.hpp) allow, by draws of both. `threads`: 0: one a core.
Eigen::MatrixXd nuisances_known(const Model& model, const FlowMaps& maps, std::uint64_t seed,
                                int threads = 0);

}  // namespace lilytank
