// The selected model as results: findings, maps, ranking, smallest detectable sizes.
#pragma once
#include "finder/model_selection.hpp"
#include "lilytank/diagnosis.hpp"

namespace lilytank {

/// Gains that differ by less do not distinguish effects.
inline constexpr double kSameGain = 4;

/// Adds verdict, findings, maps, ranking, thresholds and smallest detectable sizes to `out`.
/// `residual`: that the selection `e` explains; `details`: with its scans; `false_alarms`:
/// false-positive rate of null experiments. Returns the effects of which each alone may be the
/// strongest finding, where these are several: it and its alternatives, strongest first; where
/// nothing explains the residual, those that come nearest.
std::vector<EffectFit> report_selection(const ReferenceEnsemble& ensemble,
                                        const ModelSelection& selection,
                                        const Eigen::VectorXd& residual, const SelectedModel& e,
                                        const ScoreDetails& details, double false_alarms,
                                        Diagnosis& out);

}  // namespace lilytank
