// Planted parameters are found again: two of them from a short recording, by every objective that
// comes with intervals of its own.
#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/calibration.hpp"
#include "lilytank/recovery.hpp"

namespace lilytank {
namespace {

RecoveryOptions small() {
  RecoveryOptions r;
  r.experiments = 3, r.recordings = 1, r.seconds = 60;
  CalibrationOptions& c = r.calibration;
  c.parameters = {{"forces.face_drag.K_F", "1", 0.2, 1, true},
                  {"forces.stochastic.sigma_stoch", "N", 0.004, 0.04, true}};
  c.search_budget = 60, c.round = 60, c.last_round = 120, c.replicates = 60;
  return r;
}

Scenario tank() {
  return load_scenario({LILYTANK_SOURCE_DIR "/scenarios/tank_lilies.toml"},
                       {"module.draught=0.025", "module.count=8"});
}

TEST(CalibrationRecovery, intervalsHoldPlantedParametersAndAreNarrow) {
  RecoveryOptions r = small();
  r.objectives = {CalibrationObjective::summary};
  const auto rows = recover(tank(), r);
  ASSERT_EQ(rows.size(), 6u);
  for (const RecoveryRow& row : rows) {
    // Four standard errors, so that a fair interval fails once in 16 000 times.
    const double error = (std::log(row.high) - std::log(row.low)) / (2 * 1.96);
    EXPECT_LT(std::fabs(std::log(row.estimate / row.truth)), 4 * error) << row.parameter;
    // A minute of eight modules tells both to within a fifth.
    EXPECT_LT(error, 0.1) << row.parameter;
  }
}

// Far from the scenario's values, without a search: four standard errors, from two minutes of eight
// modules.
TEST(CalibrationRecovery, PredictionsFindTheWayFromAfar) {
  RecoveryOptions r;
  r.experiments = 1, r.recordings = 2, r.seconds = 60, r.rate = 15;
  r.objectives = {CalibrationObjective::prediction};
  r.calibration.seed = 22, r.calibration.round = 40, r.calibration.last_round = 40;
  r.calibration.replicates = 40;
  const auto rows = recover(tank(), r);
  ASSERT_EQ(rows.size(), 5u);
  for (const RecoveryRow& row : rows) {
    const FitParameter scale{"", "", row.bound_low, row.bound_high, row.logarithmic, false};
    const double off = scale.to_scale(row.estimate) - scale.to_scale(row.truth);
    const double error = (scale.to_scale(row.high) - scale.to_scale(row.low)) / (2 * 1.96);
    EXPECT_LT(std::fabs(off), 4 * error) << row.parameter;
    if (row.logarithmic) {
      EXPECT_LT(error, 0.25) << row.parameter;
    }
  }
}

TEST(CalibrationRecovery, isTheSameForAnyNumberOfThreads) {
  RecoveryOptions r = small();
  r.experiments = 1, r.seconds = 20;
  r.objectives = {CalibrationObjective::summary, CalibrationObjective::prediction};
  r.calibration.threads = 1;
  const auto one = recover(tank(), r);
  r.calibration.threads = 3;
  const auto three = recover(tank(), r);
  EXPECT_EQ(recovery_csv(one), recovery_csv(three));
}

}  // namespace
}  // namespace lilytank
