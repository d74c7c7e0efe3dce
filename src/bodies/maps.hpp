// What the baseline leaves: the pushes that its filter needs, over a variable.
#pragma once
#include "bodies/verdict.hpp"

namespace lilytank::bodies {

/// Over slip (along the motion), position, pair (outwards) or time; an empty curve where these
/// recordings have no such variable.
FoundCurve map_of(const Comparison& comparison, const std::string& variable);
std::vector<FoundCurve> maps_of(const Comparison& comparison);

}  // namespace lilytank::bodies
