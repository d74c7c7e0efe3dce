// Whether proposed experiments split groups: each is recorded in the synthetic world, and both
// recordings are compared together.
#pragma once
#include <functional>
#include <vector>

#include "finder/proposal.hpp"
#include "lilytank/proof.hpp"

namespace lilytank {

/// Further recordings of a world with so many modules, `which` numbers them; none if it diverges.
using FurtherRecording =
    std::function<std::vector<Recording>(int modules, double minutes, int which)>;

/// Splits the candidates by up to two proposals and, beside that, by repeating the recordings
/// `judged` until that splits them. Twice the log-likelihood ratio of two effects is that of the
/// diagnosis plus what the predictor gains on the further recordings; a group is split once it is
/// at least that which groups are made by. Throws Stopped.
ProofLoop closed_loop(PreparedTank& tank, const OpenQuestion& question,
                      const std::vector<Recording>& judged, const FurtherRecording& further);

}  // namespace lilytank
