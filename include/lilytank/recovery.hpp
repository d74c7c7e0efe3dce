// Whether a calibration's intervals can be trusted: synthetic experiments with known parameters,
// calibrated like any other.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lilytank/calibration.hpp"

namespace lilytank {

/// One interval and the truth.
struct RecoveryRow {
  /// Number of the synthetic experiment, from 0.
  int experiment = 0;
  /// Name of the objective, and dotted path of the parameter.
  std::string objective, parameter;
  /// In the parameter's unit; low .. high is the 95 % interval.
  double truth = 0, estimate = 0, low = 0, high = 0;
  /// Bounds of the parameter in the fit.
  double bound_low = 0, bound_high = 0;
  /// Whether it is fitted on a logarithmic scale.
  bool logarithmic = false;
  /// Whether the interval holds the truth.
  bool covered() const { return low <= truth && truth <= high; }
  /// Width of the interval and, of one that misses the truth, forty times by how much: least, on
  /// average, for intervals that are honest and narrow. As a share of the bounds, by factors where
  /// the range is searched so [Gneiting and Raftery, J. Am. Stat. Assoc. 102, 2007, Eq. 43].
  double interval_score() const;
};

/// The synthetic experiments and how each is calibrated.
struct RecoveryOptions {
  /// Number of synthetic experiments.
  int experiments = 10;
  /// Recordings of Lilies in an experiment.
  int recordings = 3;
  /// Length of a recording, s.
  double seconds = 600;
  /// Frames per second.
  double rate = 30;
  /// Standard deviations of the camera's errors, m and rad.
  double position_noise = 3e-4, heading_noise = 0.01;
  /// Balls in each of as many recordings of balls; 0: the flow is known.
  int balls = 0;
  std::vector<CalibrationObjective> objectives{CalibrationObjective::prediction,
                                               CalibrationObjective::msd};
  /// Settings of each calibration; objective, flow and directory are set by recover().
  CalibrationOptions calibration;
  /// Called with all rows so far when an experiment is done; may be empty.
  std::function<void(const std::vector<RecoveryRow>&)> done;
};

/// Draws true parameters, uniform over the middle half of each range (by factors where the range is
/// searched so), simulates recordings with per-point gusts and calibrates from the scenario's
/// values. Experiments that diverge are drawn again. Throws Stopped.
std::vector<RecoveryRow> recover(const Scenario& scenario, const RecoveryOptions& options);

/// Coverage, bias, width and mean interval score by objective and parameter.
std::string recovery_text(const std::vector<RecoveryRow>& rows);
/// One row an interval.
std::string recovery_csv(const std::vector<RecoveryRow>& rows);

}  // namespace lilytank
