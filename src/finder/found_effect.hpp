// An effect at the direct estimates of its parameters, at which its experiments are simulated.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "finder/candidate.hpp"
#include "scores/score_plan.hpp"
#include "scores/scores.hpp"

namespace lilytank {

/// The effect of the plan that a fit is of; not of a shape.
const Effect& effect_in(const ScorePlan& plan, const EffectFit& fit);

/// Direct estimates of an effect from recordings.
struct ScannedEffect {
  std::vector<HeldParameter> held;
  std::optional<JointAmplitudes> amplitudes;
};

/// A stream or patch at its place with its strength, a force between modules of its range, vortices
/// of their frequency; nothing of other effects, or where the recordings do not show it.
std::optional<ScannedEffect> scanned(const Effect& effect, const ScoreDetails& details);

/// What a fit is of, at the direct estimates: the line of pumps, the module that differs, what is
/// scanned.
Effect found_effect(const ScorePlan& plan, const EffectFit& fit, const ScoreDetails& details);

/// Name of the experiments with it. Nearly equal pulsation frequencies share theirs.
std::string stage_name(const ScorePlan& plan, const EffectFit& fit, const ScoreDetails& details);

}  // namespace lilytank
