// What a diagnosis starts from: an experiment, options, and the stages that simulate for it.
#pragma once
#include <string>
#include <vector>

#include "calibrate/stages.hpp"
#include "finder/fingerprint.hpp"
#include "lilytank/diagnosis.hpp"

namespace lilytank {

/// Simulations of each kind; ten minutes on two cores by default.
struct DiagnosisBudget {
  int flow_draws, centre, nulls, round, comparisons;
  Learning learning;
  explicit DiagnosisBudget(double minutes);
};

/// Calibration of the baseline and its stages with a diagnosis' options. Not copied: the stages
/// refer to the calibration.
struct DiagnosisSetup {
  DiagnosisSetup(const Experiment& experiment, const DiagnosisOptions& diagnosis_options);
  DiagnosisSetup(const DiagnosisSetup&) = delete;
  DiagnosisSetup& operator=(const DiagnosisSetup&) = delete;

  /// Of the recordings, the model and the options that results depend on.
  std::string identity() const;
  /// Simulated experiments of a model that is fitted and shown.
  double model_cost() const { return 3 * budget.round + 2 * budget.comparisons; }

  DiagnosisOptions options;
  DiagnosisBudget budget;
  CalibrationSetup calibration;
  Stages stages;
};

}  // namespace lilytank
