// How modules latch and part: what recordings with latches on show beside their motion. Bonds are
// recognised from poses (tracks/seen_bonds.hpp); where the modules' radio was logged, what they
// decided is known as well.
#pragma once
#include <vector>

#include "scores/score_plan.hpp"

namespace lilytank {

/// Names of the numbers, all of the group "bond".
std::vector<ScoreEntry> bond_entries(const ScorePlan& plan);
/// The numbers, all recordings together: logarithms of rates and of mean times, shares. Finite.
std::vector<double> bond_numbers(const ScorePlan& plan, const std::vector<Recording>& recordings);

}  // namespace lilytank
