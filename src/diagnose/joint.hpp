// Baseline and effects fitted together, as calibration does with the baseline alone.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "diagnose/atlas.hpp"

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

/// Effects are dropped, weakest first, that the data no longer ask for once everything is fitted
/// together: a name may have stood for a baseline that another effect had pushed aside. At least
/// one is kept. `keep`: z by which an effect's amplitudes must differ from nothing. `amplitudes`:
/// the naming's, in units of each effect's sizes. `baseline`: where its parameters are expected
/// beside them, and how surely (deviations of the first design). `round`: simulations of a round;
/// `replicates`: for the intervals. `tag`: for the names of what is kept.
JointFit fit_jointly(Stages& stages, const FlowMaps& maps, const Atlas& atlas,
                     std::vector<Effect> effects, std::vector<Eigen::VectorXd> amplitudes,
                     const Vectors& observed, const JointStart& baseline, int round, int replicates,
                     double keep, const std::string& tag, std::uint64_t seed);

}  // namespace lilytank
