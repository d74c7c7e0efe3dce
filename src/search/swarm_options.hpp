// What a swarm is asked to be: checks, and its text in a saved state.
#pragma once
#include "lilytank/search.hpp"
#include "search/state_text.hpp"

namespace lilytank {

/// Throws InputError.
void check_swarm_options(const SwarmOptions& options, const SearchSpace& space);
void save_swarm_options(StateWriter& out, const SwarmOptions& options);
/// Throws InputError on what check_swarm_options refuses.
SwarmOptions load_swarm_options(StateReader& in, const SearchSpace& space);

}  // namespace lilytank
