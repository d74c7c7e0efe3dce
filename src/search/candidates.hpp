// Tallies as candidates for the allocation of a budget.
#pragma once
#include <span>
#include <vector>

#include "lilytank/search.hpp"
#include "search/tally.hpp"

namespace lilytank {

/// Deviations from so few values are drawn towards the one that all candidates share: each weighs
/// its own as its values less one, the common one as kPriorValues. 1 for all where no candidate has
/// two values.
std::vector<OcbaCandidate> candidates_of(std::span<const Tally* const> tallies);
inline constexpr double kPriorValues = 4;

}  // namespace lilytank
