// Baseline and effects fitted together, as calibration does with the baseline alone.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "finder/reference_ensemble.hpp"

namespace lilytank {

/// A model with effects: the baseline's parameters and nuisances first, then amplitudes and what is
/// refined of each effect.
struct JointFit {
  std::vector<FitParameter> parameters;
  Model model;                           ///< with every effect switched on, at its held numbers
  std::vector<double> value, low, high;  ///< 95 % intervals
  std::vector<std::size_t> kept;         ///< which of the effects it still needs
  bool settled = false;
};

/// Share of a parameter's range to which it is taken to be known before any data speak.
inline constexpr double kPrior = 0.15;

/// Of the baseline's parameters, in their scale.
struct JointStart {
  Eigen::VectorXd expected;          ///< before any data
  Eigen::VectorXd point, deviation;  ///< where the first design is, and how wide
};

/// An effect that was found, and how much of it.
struct JointEffect {
  Effect effect;
  Eigen::VectorXd amplitudes;  ///< the selection's, in units of the effect's sizes
  int shape = -1;              ///< the plan's, if it is one: then its own scores speak as well
};

/// Rounds of simulations.
struct JointRounds {
  int count = 80;   ///< simulations of one
  double keep = 4;  ///< z by which an effect's amplitudes must differ from nothing
  std::string tag;  ///< for the names of what is kept
  std::uint64_t seed = 1;
};

/// Effects are dropped, weakest first, that the data no longer ask for once everything is fitted
/// together: a name may have stood for a baseline that another effect had pushed aside. At least
/// one is kept. `baseline`: where its parameters are expected beside them, and how surely
/// (deviations of the first design).
JointFit fit_jointly(Stages& stages, const FlowMaps& maps, const ReferenceEnsemble& ensemble,
                     std::vector<JointEffect> effects, const std::vector<Recording>& recordings,
                     const JointStart& baseline, const JointRounds& rounds);

}  // namespace lilytank
