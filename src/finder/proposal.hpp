// The next experiment for what a diagnosis leaves open.
#pragma once
#include <vector>

#include "finder/judgement.hpp"
#include "lilytank/next_experiment.hpp"

namespace lilytank {

/// Experiments that distinguish the strongest finding from its alternatives, or where a residual
/// has no name the effects that come nearest, best first; none for other verdicts, and where fewer
/// than two of the effects have a mean force, which the filter could predict. `fitted`: the
/// recordings that were judged. Throws Stopped.
std::vector<ProposedExperiment> next_experiments(PreparedTank& tank, const Judged& judged,
                                                 const std::vector<Recording>& fitted,
                                                 const Diagnosis& diagnosis);

}  // namespace lilytank
