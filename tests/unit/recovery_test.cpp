// What a table of recovered parameters says of intervals.
#include "lilytank/recovery.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lilytank {
namespace {

RecoveryRow row(double truth, double low, double high, bool logarithmic) {
  RecoveryRow r{1, "summary", "forces.damping.D_linear", truth, 0.5 * (low + high), low, high};
  r.bound_low = logarithmic ? 0.1 : 0, r.bound_high = logarithmic ? 10 : 0.5;
  r.logarithmic = logarithmic;
  return r;
}

TEST(RecoveryRow, theScoreIsTheWidthAndFortyTimesWhatIsMissed) {
  EXPECT_NEAR(row(0.25, 0.2, 0.3, false).interval_score(), 0.1 / 0.5, 1e-12);
  EXPECT_NEAR(row(0.31, 0.2, 0.3, false).interval_score(), (0.1 + 40 * 0.01) / 0.5, 1e-12);
  EXPECT_NEAR(row(0.19, 0.2, 0.3, false).interval_score(), (0.1 + 40 * 0.01) / 0.5, 1e-12);
}

TEST(RecoveryRow, theScoreOfARangeOfFactorsIsByFactors) {
  EXPECT_NEAR(row(1, 0.5, 2, true).interval_score(), std::log(4.0) / std::log(100.0), 1e-9);
  EXPECT_NEAR(row(4, 0.5, 2, true).interval_score(),
              (std::log(4.0) + 40 * std::log(2.0)) / std::log(100.0), 1e-9);
}

TEST(RecoveryText, tellsCoverageAndScoreOfEachObjective) {
  RecoveryRow missed = row(0.31, 0.2, 0.3, false);
  missed.experiment = 2;
  const std::string text = recovery_text({row(0.25, 0.2, 0.3, false), missed});
  EXPECT_NE(text.find("1 of 2"), std::string::npos) << text;
  EXPECT_NE(text.find("60.0"), std::string::npos) << text;  // half of 20 % and 100 %
}

}  // namespace
}  // namespace lilytank
