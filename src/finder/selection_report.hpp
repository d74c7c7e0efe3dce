// The selected model as results: findings, maps, ranking, smallest detectable sizes.
#pragma once
#include "finder/refinement.hpp"
#include "lilytank/diagnosis.hpp"

namespace lilytank {

/// Adds verdict, findings, maps, ranking, thresholds and smallest detectable sizes to `out`.
/// `residual`: that the selection explains; `false_alarms`: false-positive rate of null
/// experiments. Returns the effects of which each alone may be the strongest finding, where these
/// are several: it and its alternatives, strongest first; where nothing explains the residual,
/// those that come nearest.
std::vector<EffectFit> report_selection(const ReferenceEnsemble& ensemble,
                                        const RefinedSelection& selected,
                                        const Eigen::VectorXd& residual, double false_alarms,
                                        Diagnosis& out);

}  // namespace lilytank
