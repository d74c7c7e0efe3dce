#include "../../render/axes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace lilytank {
namespace {

using Texts = std::vector<std::string>;

Texts labels(const Axis& axis) {
  Texts texts;
  for (const AxisTick& t : axis.ticks) {
    if (!t.label.empty()) texts.push_back(t.label);
  }
  return texts;
}

TEST(Axes, TicksAreRoundNumbers) {
  EXPECT_EQ(labels(make_axis(0, 10, false, 5, false)), (Texts{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(labels(make_axis(-0.13, 0.24, false, 4, false)), (Texts{"−0.1", "0.0", "0.1", "0.2"}));
  EXPECT_EQ(labels(make_axis(0, 3.2, false, 4, true)), (Texts{"0", "1", "2", "3"}));
}

TEST(Axes, OneLabelIsNoScale) {
  EXPECT_EQ(labels(make_axis(-15.4, 14, false, 2, false)), (Texts{"−10", "0", "10"}));
  for (int k = 1; k < 200; ++k) {
    const double low = -0.37 * k, high = 0.011 * k * k;
    EXPECT_GE(labels(make_axis(low, high, false, 2, false)).size(), 2U) << low << " .. " << high;
  }
}

TEST(Axes, LongNumbersAreShortenedByANote) {
  const Axis small = make_axis(0, 4e-7, false, 4, false);
  EXPECT_EQ(small.note, "×10⁻⁷");
  EXPECT_EQ(labels(small), (Texts{"0", "1", "2", "3", "4"}));
  const Axis offset = make_axis(1e6, 1e6 + 0.4, false, 4, false);
  EXPECT_EQ(offset.note, "+1000000");
  EXPECT_EQ(labels(offset), (Texts{"0.0", "0.1", "0.2", "0.3", "0.4"}));
}

TEST(Axes, LogAxesOfFewLabelsHaveTwo) {
  const Axis axis = make_axis(0.04, 45, true, 2, false);
  EXPECT_GE(std::count_if(axis.ticks.begin(), axis.ticks.end(),
                          [](const AxisTick& t) { return !t.label.empty(); }),
            2);
}

TEST(Axes, PowersOfUnitsAreRaised) {
  EXPECT_EQ(with_superscripts("m/s^2"), "m/s²");
  EXPECT_EQ(with_superscripts("1/(m^2 s^-10)"), "1/(m² s⁻¹⁰)");
  EXPECT_EQ(with_superscripts("N m"), "N m");
  EXPECT_EQ(power_of_ten(-3), "10⁻³");
}

TEST(Axes, LogAxesCountDecades) {
  const Axis axis = make_axis(1e-6, 1e-1, true, 6, false);
  EXPECT_EQ(labels(axis), (Texts{"10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"}));
  EXPECT_NEAR(axis.share(1e-6), 0, 1e-12);
  EXPECT_NEAR(axis.share(1e-1), 1, 1e-12);
  EXPECT_NEAR(axis.share(std::sqrt(1e-7)), 0.5, 1e-12);
  EXPECT_TRUE(std::isnan(axis.share(0)));
  EXPECT_TRUE(std::isnan(axis.share(-1)));
  EXPECT_EQ(labels(make_axis(1, 100, true, 6, false)), (Texts{"1", "10", "100"}));
  EXPECT_EQ(labels(make_axis(1, 20, true, 6, false)), (Texts{"1", "2", "5", "10", "20"}));
}

// Whatever the range: ticks rise, lie on the axis, are neither none nor many, and no two labels
// are the same.
TEST(Axes, EveryRangeGivesAUsableAxis) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<double> ends = {-inf, -1.7e308, -1e9,     -3.3,  -1e-12,      -1e-310,
                                    0,    1e-310,   1e-300,   2e-12, 0.1,         0.1 + 1e-15,
                                    0.12, 1,        1 + 1e-9, 7,     1e5,         1e5 + 1,
                                    3e15, 1e300,    1.7e308,  inf,   std::nan("")};
  for (const double low : ends) {
    for (const double high : ends) {
      for (int kind = 0; kind < 4; ++kind) {
        const Axis axis = make_axis(low, high, kind & 1, 6, kind & 2);
        SCOPED_TRACE(testing::Message() << low << " " << high << " kind " << kind);
        ASSERT_TRUE(std::isfinite(axis.low) && std::isfinite(axis.high));
        ASSERT_LT(axis.low, axis.high);
        ASSERT_LE(axis.ticks.size(), 120u);
        ASSERT_FALSE(labels(axis).empty());
        double before = -inf;
        std::set<std::string> seen;
        for (const AxisTick& t : axis.ticks) {
          ASSERT_GT(t.value, before);
          before = t.value;
          ASSERT_GT(axis.share(t.value), -0.01);
          ASSERT_LT(axis.share(t.value), 1.01);
          if (!t.label.empty()) {
            ASSERT_TRUE(seen.insert(t.label).second) << t.label;
            ASSERT_LT(t.label.size(), 40u) << t.label;
          }
        }
      }
    }
  }
}

TEST(Axes, RangesIgnoreWhatCannotBeShown) {
  Range range;
  EXPECT_TRUE(range.empty());
  for (const double v : {std::nan(""), -1.0, 0.0, 3.0}) range.add(v, true);
  EXPECT_EQ(range.low(), 3);
  EXPECT_EQ(range.high(), 3);
  EXPECT_TRUE(range.whole());
  range.add(3.5, true);
  EXPECT_FALSE(range.whole());
}

}  // namespace
}  // namespace lilytank
