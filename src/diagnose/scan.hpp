// Where in the tank a stream would explain most.
#pragma once
#include <vector>

#include "diagnose/score_plan.hpp"

namespace lilytank {

/// The stream among those of several widths about the places of a hexagonal grid that raises the
/// one-step likelihood of recordings most, each component by itself.
StreamPlace find_stream(const ScorePlan& plan, const std::vector<Recording>& recordings);

}  // namespace lilytank
