// What innovations show: how much of each effect's force is in them, how they scatter, and what
// happens when modules touch.
//
// A force that the model lacks shows in the next innovations by way of the filter: its sensitivity
// is carried along like the state itself, from past frames only, so a score is a sum of products of
// which the second factor cannot know the first. Scores are cleared of what errors of parameters
// and of the flow could have done (nuisances.hpp) and divided by the information that is left, so
// each is an estimate of the effect's amplitude, in units of the size at which it is tried; that
// estimate is biased by all that the filter leaves out, as is its expectation by simulation
// (reference_ensemble.hpp).
#pragma once
#include <vector>

#include "filter/sensitivity.hpp"
#include "scores/score_plan.hpp"

namespace lilytank {

/// The vector of recordings, in the order of the plan's entries; always finite.
std::vector<double> score(const ScorePlan& plan, const std::vector<Recording>& recordings,
                          ScoreDetails* details = nullptr);

/// Information of every two of the scores of the plan's effects and, after them, of further ones,
/// by what they would have done to recordings, [component, component]: what simulated experiments
/// show only roughly. 0 where there is none.
Eigen::MatrixXd score_informations(ScorePlan plan, const std::vector<Recording>& recordings,
                                   const std::vector<Effect>& further = {});
/// Scores of the amplitudes of effects with a mean force and, after them, of the plan's nuisances,
/// and the information of every two: nothing is eliminated, so those of several recordings add up.
struct ScoreSums {
  Eigen::VectorXd scores;
  Eigen::MatrixXd information;
};
ScoreSums score_sums(ScorePlan plan, const std::vector<Recording>& recordings,
                     const std::vector<Effect>& effects);
/// Information of an effect's amplitude, in sizes, that it is 0 before any data: what modules
/// hardly ever felt could else have any estimate. A score is its estimate times own / (own +
/// this).
inline constexpr double kScoreKnown = 1;
/// Correlations that scores with such information have among experiments.
Eigen::MatrixXd correlations_of(const Eigen::MatrixXd& informations);
/// Variance of a score that no other has, where correlations are divided out.
inline constexpr double kUniqueVariance = 0.01;

/// Every scored component of the plan's effects alone: its amplitude, in sizes.
std::vector<Sensitivities::Amplitude> scored_amplitudes(const ScorePlan& plan,
                                                        const std::vector<Recording>& recordings);

/// The amplitudes of all components of one effect together, in sizes, and by how much they raise
/// twice the log-likelihood.
struct JointAmplitudes {
  Eigen::VectorXd estimate;
  double gain = 0;
};
/// Those of every effect, each by itself; effects without a mean force have none.
std::vector<JointAmplitudes> joint_amplitudes(ScorePlan plan,
                                              const std::vector<Recording>& recordings,
                                              const std::vector<Effect>& effects);

/// Minus twice the log-likelihood of recordings, one step ahead, at the likeliest errors of the
/// plan's parameters and flow map and the likeliest amplitudes of the effects beside; less a
/// constant of the recordings.
double deviance_of(ScorePlan plan, const std::vector<Recording>& recordings);

}  // namespace lilytank
