// What innovations tell: how much of each effect's force is in them, how they scatter, and what
// happens when modules touch.
//
// A force that the model lacks shows in the next innovations by way of the filter: its sensitivity
// is carried along like the state itself, from past frames only, so a score is a sum of products of
// which the second factor cannot know the first. Scores are divided by their information, so each
// is an estimate of the effect's amplitude, in units of the size at which it is tried; that
// estimate is biased by all that the filter leaves out, as is its expectation by simulation
// (atlas.hpp).
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "diagnose/effects.hpp"
#include "lilytank/predictor.hpp"

namespace lilytank {

/// One number of the vector that is compared.
struct ScoreEntry {
  std::string group;  ///< score, module, noise, spectrum, contact, camera, shape
  std::string name;
};

/// What is measured: fixed before anything is measured, the same for recordings and simulations.
struct ScorePlan {
  Model model;  ///< the predictor's
  PredictorOptions predictor;
  std::vector<Effect> effects;
  std::vector<Shape> shapes;
  double rate = 30;
  int modules = 15;  ///< identities in all recordings

  std::vector<ScoreEntry> entries() const;
  /// Where the knots of shape `index` begin in the vector.
  std::size_t first_of_shape(std::size_t index) const;
};

/// Beside the vector, what a verdict needs of one experiment.
struct ScoreDetails {
  double pulsation = 0;  ///< Hz, the strongest line in the flow's gain
  int heaviest = 0;      ///< module that answers least
};

/// The vector of recordings, in the order of the plan's entries; always finite.
std::vector<double> score(const ScorePlan& plan, const std::vector<Recording>& recordings,
                          ScoreDetails* details = nullptr);

}  // namespace lilytank
