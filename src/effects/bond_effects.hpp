// Effects on how modules latch, decide and part. No force stands behind them: they change the
// numbers of the modules' control.
#pragma once
#include <vector>

#include "effects/effects.hpp"

namespace lilytank {

/// Those that a model with latches can have; none without latches.
std::vector<Effect> bond_effects(const Model& model);

}  // namespace lilytank
