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
  int experiment = 0;
  std::string objective, parameter;
  double truth = 0, estimate = 0, low = 0, high = 0;  ///< 95 %
  double bound_low = 0, bound_high = 0;
  bool logarithmic = false;
  bool covered() const { return low <= truth && truth <= high; }
  /// Width of the interval and, of one that misses the truth, forty times by how much: least, on
  /// average, for intervals that are honest and narrow. As a share of the bounds, by factors where
  /// the range is searched so [Gneiting and Raftery, J. Am. Stat. Assoc. 102, 2007, Eq. 43].
  double interval_score() const;
};

struct RecoveryOptions {
  int experiments = 10;
  int recordings = 3;                                  ///< of Lilies in an experiment
  double seconds = 600;                                ///< of a recording
  double rate = 30;                                    ///< frames per second
  double position_noise = 3e-4, heading_noise = 0.01;  ///< m, rad
  int balls = 0;  ///< of as many recordings of balls; 0: the flow is taken as known
  std::vector<CalibrationObjective> objectives{CalibrationObjective::summary,
                                               CalibrationObjective::msd};
  CalibrationOptions calibration;  ///< of each; its objective, flow and directory are set
  /// Called with all rows so far when an experiment is done; may be empty.
  std::function<void(const std::vector<RecoveryRow>&)> done;
};

/// Draws true parameters, uniform over the middle half of each range (by factors where the range is
/// searched so), simulates recordings with per-point gusts and calibrates from the scenario's
/// values. Experiments whose worlds diverge are drawn again. Nothing if it was stopped.
std::optional<std::vector<RecoveryRow>> recover(const Scenario& scenario,
                                                const RecoveryOptions& options);

/// Coverage, bias, width and mean interval score by objective and parameter.
std::string recovery_text(const std::vector<RecoveryRow>& rows);
/// One row an interval.
std::string recovery_csv(const std::vector<RecoveryRow>& rows);

}  // namespace lilytank
