// Errors of a model's parameters, as its predictions one frame ahead show them.
#pragma once
#include <string>
#include <vector>

#include "scores/score_plan.hpp"

namespace lilytank {

/// The model as a predictor, with a filter that is tuned to the noise of these recordings.
/// `bodies`: of a simulated experiment.
ScorePlan prediction_plan(const Model& model, const std::vector<Recording>& recordings, int bodies);

/// What the numbers are, in their order.
std::vector<std::string> prediction_names();

/// The changes of drag, flow and gusts (relative) and of both dampings (1/s) that explain the
/// innovations best, to first order. They are biased: the filter knows velocities only roughly, and
/// contacts and the flow map's errors are left out. Simulated experiments have the same bias.
std::vector<double> prediction_numbers(const ScorePlan& plan,
                                       const std::vector<Recording>& recordings);

}  // namespace lilytank
