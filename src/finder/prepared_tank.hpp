// What is simulated once for a tank and serves any number of its experiments: flow maps, the
// calibrated baseline, null experiments and fingerprints.
#pragma once
#include <Eigen/Core>

#include "finder/diagnosis_setup.hpp"
#include "finder/model_selection.hpp"
#include "finder/reference_ensemble.hpp"
#include "lilytank/flow_maps.hpp"

namespace lilytank {

/// The baseline's parameters (fitted scale) and their errors.
struct BaselineEstimate {
  Eigen::VectorXd point, deviation;
  bool settled = false;  ///< the estimate lay among the simulated points
};

/// Not copied: the ensemble refers to the maps.
class PreparedTank {
 public:
  /// Simulates what the directory does not hold yet; it must be claimed. `after`: simulated
  /// experiments that follow, for the progress. `setup` must outlive this. Throws Stopped,
  /// InputError.
  explicit PreparedTank(DiagnosisSetup& setup, double after = 0);
  PreparedTank(const PreparedTank&) = delete;
  PreparedTank& operator=(const PreparedTank&) = delete;

  /// The baseline alone, with the parameters at these scaled values.
  Model baseline_at(const Eigen::VectorXd& scaled) const;

  DiagnosisSetup& setup;
  const FlowMaps maps;
  const BaselineEstimate baseline;
  const Eigen::MatrixXd spread;  ///< of the ensemble's parameters
  ReferenceEnsemble ensemble;
  const ModelSelection selection;

 private:
  BaselineEstimate estimate_baseline() const;
  BaselineEstimate moved_to(const BaselineEstimate& before, int round,
                            const FitBounds& bounds) const;
  Eigen::MatrixXd null_spread() const;
  ScorePlan plan() const;
};

}  // namespace lilytank
