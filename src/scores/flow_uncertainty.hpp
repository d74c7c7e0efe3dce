// Uncertainty of a flow map: its error draws, inflated, and smooth errors of the mean and of the
// gusts. No finding may be explained by these.
#pragma once
#include <cstdint>
#include <memory>

#include "lilytank/flow_maps.hpp"

namespace lilytank {

/// The true flow is so many deviations of its posterior from the best map, measured on blinded
/// tanks (1.2 to 1.7): most at the centre and at the wall, where balls are rare.
inline constexpr double kPosteriorScale = 1.4;

/// Draw `run` of the fields that could be the true one, kPosteriorScale times as far from the best
/// one as balls leave open, and a smooth random error of `seed` added: of the mean 2 % of its root
/// mean square per axis, over lengths of a quarter of the tank and more; of the gusts' deviation a
/// common 3 % and a smooth 3 %.
std::shared_ptr<const FlowField> perturbed_flow(const FlowMaps& maps, std::uint64_t field_seed,
                                                std::uint64_t seed, std::int64_t run);

}  // namespace lilytank
