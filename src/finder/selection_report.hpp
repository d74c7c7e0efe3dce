// The selected model as results: findings, maps, ranking, smallest detectable sizes.
#pragma once
#include "finder/model_selection.hpp"
#include "lilytank/diagnosis.hpp"

namespace lilytank {

/// Adds verdict, findings, maps, ranking, thresholds and smallest detectable sizes to `out`.
/// `residual`: that the selection `e` explains; `false_alarms`: false-positive rate of null
/// experiments.
void report_selection(const ReferenceEnsemble& ensemble, const ModelSelection& selection,
                      const Eigen::VectorXd& residual, const SelectedModel& e, double false_alarms,
                      Diagnosis& out);

}  // namespace lilytank
