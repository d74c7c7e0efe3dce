// What the findings change: recordings that had no part in them, against simulations without and
// with the effects.
#pragma once
#include <vector>

#include "finder/joint.hpp"
#include "finder/reference_ensemble.hpp"
#include "lilytank/diagnosis.hpp"

namespace lilytank {

/// Simulates the shapes of recordings at values of an emulator's parameters, `count` times. Throws
/// Stopped, InputError.
std::vector<std::vector<Recording>> repeat(const Stages& stages, const FlowMaps& maps,
                                           const Emulator& emulator,
                                           const std::vector<double>& values, int count,
                                           std::uint64_t seed);

/// Groups of the motion summary and contacts: mean squared deviation of the recordings' numbers
/// from those of simulations before and after.
std::vector<GroupFit> group_fits(const CalibrationSetup& setup, const ScorePlan& plan,
                                 const std::vector<Recording>& recordings,
                                 const std::vector<std::vector<Recording>>& before,
                                 const std::vector<std::vector<Recording>>& after);

/// Eq. 9 of the recordings before and after, its floor, and the share removed with its interval.
void msd_share(const std::vector<Recording>& recordings,
               const std::vector<std::vector<Recording>>& before,
               const std::vector<std::vector<Recording>>& after, double longest, Diagnosis& out);

/// Gain in log-likelihood, one step ahead, of one model over another: nat, and its 95 % interval
/// by blocks of ten seconds. Pumps that pulsate have the phase that predicts each recording best.
struct StepGain {
  double gain = 0, low = 0, high = 0;
};
StepGain step_gain(const Model& before, const Model& after, const PredictorOptions& predictor,
                   const std::vector<Recording>& recordings);

/// Whether `after` is likelier than the plan's model once errors of parameters and of the flow are
/// allowed for in both: these may cost a right model more, one step ahead, than a weak effect
/// gains.
bool likelier_but_for_errors(const ScorePlan& plan, const Model& after,
                             const std::vector<Recording>& recordings);

}  // namespace lilytank
