// The next experiment for what a diagnosis leaves open.
#pragma once
#include <vector>

#include "finder/judgement.hpp"
#include "finder/next_experiment.hpp"

namespace lilytank {

/// The effects of which each alone may be the strongest finding, where the verdict leaves several,
/// or where a residual has no name those that come nearest; without those that have no mean force,
/// which the filter does not predict. No candidates if one of those leads.
OpenQuestion open_question(const ScorePlan& plan, const Judged& judged, Verdict verdict);

/// Experiments that distinguish its candidates, best first. `fitted`: recordings that the
/// candidates were fitted to. Throws Stopped.
std::vector<ProposedExperiment> proposals(PreparedTank& tank, const OpenQuestion& question,
                                          const std::vector<Recording>& fitted);

}  // namespace lilytank
