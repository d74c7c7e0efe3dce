// Uncertainty of a flow map: its error draws, inflated, and smooth errors of the mean and of the
// gusts. No finding may be explained by these.
#pragma once
#include <cstdint>
#include <memory>

#include "lilytank/flow_maps.hpp"

namespace lilytank {

/// Draw `run` of the fields that could be the true one, 1.4 times as far from the best one as balls
/// leave open, and a smooth random error of `seed` added: of the mean 2 % of its root mean square
/// per axis, over lengths of a quarter of the tank and more; of the gusts' deviation a common 3 %
/// and a smooth 3 %.
std::shared_ptr<const FlowField> perturbed_flow(const FlowMaps& maps, std::uint64_t field_seed,
                                                std::uint64_t seed, std::int64_t run);

}  // namespace lilytank
