// How far a flow map may be off beyond what its own error draws say: smooth errors of the mean and
// of the gusts, which no finding may rest on.
#pragma once
#include <cstdint>
#include <memory>

#include "lilytank/flow_field.hpp"

namespace lilytank {

/// The field with a smooth random error added: of the mean 3 % of its root mean square per axis,
/// over lengths of a quarter of the tank and more; of the gusts' deviation a common 4 % and a
/// smooth 4 %. Draw `run`.
std::shared_ptr<const FlowField> loosened(const FlowField& field, std::uint64_t seed,
                                          std::int64_t run);

}  // namespace lilytank
