// What innovations tell: how much of each effect's force is in them, how they scatter, and what
// happens when modules touch.
//
// A force that the model lacks shows in the next innovations by way of the filter: its sensitivity
// is carried along like the state itself, from past frames only, so a score is a sum of products of
// which the second factor cannot know the first. Scores are cleared of what errors of parameters and
// of the flow could have done (nuisances.hpp) and divided by the information that is left, so each is
// an estimate of the effect's amplitude, in units of the size at which it is tried; that estimate is
// biased by all that the filter leaves out, as is its expectation by simulation (atlas.hpp).
#pragma once
#include <vector>

#include "diagnose/score_plan.hpp"

namespace lilytank {

/// The vector of recordings, in the order of the plan's entries; always finite.
std::vector<double> score(const ScorePlan& plan, const std::vector<Recording>& recordings,
                          ScoreDetails* details = nullptr);

/// Correlations of the scores of the plan's effects, [component, component], by how alike what they
/// would have done to recordings is: what simulated experiments tell only roughly.
Eigen::MatrixXd score_correlations(ScorePlan plan, const std::vector<Recording>& recordings);

/// Every scored component of the plan's effects alone: its amplitude, in sizes, and by how much it
/// raises twice the log-likelihood.
struct ScoredAmplitude {
  double estimate = 0, gain = 0;
};
std::vector<ScoredAmplitude> scored_amplitudes(const ScorePlan& plan,
                                               const std::vector<Recording>& recordings);

}  // namespace lilytank
