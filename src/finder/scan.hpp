// Numbers of effects that recordings show directly: where in the tank a stream or a patch would
// explain most, over which range a force between modules would, beside the effects of plan.beside.
#pragma once
#include <map>
#include <vector>

#include "scores/score_plan.hpp"

namespace lilytank {

/// The place of an effect that has one, and its width, with which the recordings are likeliest,
/// one step ahead and errors of the flow allowed for, of several widths about the places of a
/// hexagonal grid. The scores of all places, which are linear, propose; the predictor with the
/// effect in its model at each proposal decides (scores.hpp, deviance_of). `threads`: 0 is one a
/// core.
PlaceScan find_place(const ScorePlan& plan, const Effect& effect,
                     const std::vector<Recording>& recordings, int threads);

/// Linear estimates of an effect that has a place about the places of a hexagonal grid, of one
/// width, each alone and cleared of what errors of parameters and of the flow can do.
struct LinearPlaces {
  const Effect* effect = nullptr;  ///< of the plan, the first of its term
  std::vector<FoundPlace> places;
};
/// Those of every term that has a place, in the order of the plan.
std::vector<LinearPlaces> linear_places(const ScorePlan& plan,
                                        const std::vector<Recording>& recordings);

/// The ranges of forces between modules and of the wall, and the thickness of its layer, that do,
/// each if twice the log-likelihood rises by 30 or more. Modules that touch do not count.
std::map<const ForceTerm*, ScannedValue> find_values(const ScorePlan& plan,
                                                     const std::vector<Recording>& recordings);

/// Both, `threads` at a time (0: one a core).
Scans scans_of(const ScorePlan& plan, const std::vector<Recording>& recordings, int threads);

}  // namespace lilytank
