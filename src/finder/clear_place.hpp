// A test for effects that have a place, at every place of the tank: scores are of a few places, and
// those between can hide an effect that is small.
#pragma once
#include <optional>
#include <vector>

#include "finder/candidate.hpp"
#include "finder/reference_ensemble.hpp"

namespace lilytank {

/// An effect that is clearer at some place than it is anywhere in null experiments.
struct ClearPlace {
  EffectFit fit;          ///< of the first effect of its term, at the clearest place of the grid
  double threshold = 0;   ///< z that null experiments exceed with the given rate
  double confidence = 0;  ///< probability that no place of a null experiment is as clear
};
struct PlaceFinding {
  std::vector<ClearPlace> clear;
  /// Effects that have no place by the same measure, linear and one step ahead, clearest first.
  std::vector<EffectFit> others;
};

/// Compares the clearest of all places with those of null experiments, which are simulated unless
/// it is less clear than `least_z`. Nothing if an effect without a place explains clearly more.
/// `false_alarms`: share of null experiments in which any effect may exceed its threshold. Throws
/// Stopped.
std::optional<PlaceFinding> find_clear_place(const ReferenceEnsemble& ensemble,
                                             const std::vector<Recording>& recordings,
                                             double least_z, double false_alarms);

}  // namespace lilytank
