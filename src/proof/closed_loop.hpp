// Whether proposed experiments split groups: each is recorded in the synthetic world, and both
// recordings are compared together.
#pragma once
#include <functional>
#include <vector>

#include "finder/next_experiment.hpp"
#include "lilytank/proof.hpp"

namespace lilytank {

/// Further recordings of a world with so many modules, `which` numbers them; none if it diverges.
using FurtherRecording =
    std::function<std::vector<Recording>(int modules, double minutes, int which)>;

/// Experiments that distinguish the candidates, best first, after these recordings.
using Proposals =
    std::function<std::vector<ProposedExperiment>(const std::vector<Recording>& so_far)>;

/// Splits the candidates by up to two proposals and, beside that, by repeating the recordings
/// `judged` until that splits them. Twice the log-likelihood ratio of two effects is that of the
/// diagnosis plus what the predictor, cleared of its bias in simulations of the baseline, gains on
/// the further recordings; a group is split once it is at least that which groups are made by.
/// Throws Stopped.
ProofLoop closed_loop(const ScorePlan& plan, const OpenQuestion& question,
                      const std::vector<Recording>& judged, const Proposals& proposals,
                      const FurtherRecording& further);

}  // namespace lilytank
