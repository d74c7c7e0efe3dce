// Under which conditions fitted values hold, as the begin of an overlay.
#pragma once
#include <string>
#include <vector>

#include "lilytank/model.hpp"
#include "lilytank/recording.hpp"

namespace lilytank {

/// Scenario keys of the tank, the water, the bodies of that kind, the contacts and the step, with
/// the model's values (SI), one line of TOML each. Without the keys in `fitted`, which the overlay
/// sets to their estimates: a key must not occur twice.
std::string fit_conditions(const Model& model, BodyKind body,
                           const std::vector<std::string>& fitted);

}  // namespace lilytank
