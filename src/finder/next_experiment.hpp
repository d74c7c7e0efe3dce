// Which further experiment distinguishes the effects that recordings leave open, predicted by the
// filter's sensitivities along a short simulation of each.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "lilytank/next_experiment.hpp"
#include "lilytank/recording.hpp"
#include "scores/score_plan.hpp"

namespace lilytank {

/// An effect at its fitted amplitudes, in units of its sizes.
struct EffectHypothesis {
  Effect effect;
  Eigen::VectorXd amplitudes;
  double gain = 0;  ///< fall of the recordings' squared distance, EffectFit::gain
};

/// Effects of which each alone may explain the recordings, beside those that are there in any case.
/// All have a mean force.
struct OpenQuestion {
  std::vector<EffectHypothesis> candidates, beside;
};

/// Its effects, the candidates first.
std::vector<Effect> effects_of(const OpenQuestion& question);

/// The recordings so far.
struct RecordedSoFar {
  const ScorePlan& plan;
  const std::vector<Recording>& fitted;
  int balls = 0;            ///< in the tank when the flow was recorded
  double ball_minutes = 0;  ///< recorded of them; 0: the flow is known
  /// ScorePlan::nuisances_known() if balls were recorded forever; empty if the flow is known.
  Eigen::MatrixXd known_with_all_balls;
};

/// Nat that a pair must be expected to gain: the log-likelihood ratio is then 8 +- 4, and a group's
/// is below 2.
inline constexpr double kWantedInformation = 8;

/// Experiments of which each distinguishes all candidates, most information per minute first; none
/// for fewer than two candidates, and where none is expected to distinguish them within an hour.
/// The bits depend on `seed` alone, not on `threads` (0: one a core).
std::vector<ProposedExperiment> propose_experiments(const RecordedSoFar& so_far,
                                                    const OpenQuestion& question,
                                                    std::uint64_t seed, int threads = 0);

}  // namespace lilytank
