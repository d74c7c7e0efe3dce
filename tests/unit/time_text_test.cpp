// Times as tables hold them.
#include "io/time_text.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lilytank {
namespace {

/// The second of two times, in s.
double second(const std::string& first, const std::string& text, std::optional<double> unit = {}) {
  TimeText times;
  if (!times.seconds(first, unit)) return NAN;
  return times.seconds(text, unit).value_or(NAN);
}

TEST(TimeText, NumbersCountFromZero) {
  EXPECT_EQ(second("5", "7.5"), 7.5);
  EXPECT_EQ(second("5", "7.5", 1e-3), 7.5e-3);
  EXPECT_EQ(second("-3", "1e2"), 100);
}

TEST(TimeText, CountsSince1970LoseNoDigit) {
  EXPECT_DOUBLE_EQ(second("1700000000.25", "1700000000.75"), 0.5);
  EXPECT_DOUBLE_EQ(second("1700000000000", "1700000000033"), 0.033);
  EXPECT_DOUBLE_EQ(second("1700000000000000", "1700000000033333"), 0.033333);
  EXPECT_DOUBLE_EQ(second("1700000000000000000", "1700000000000000001"), 1e-9);
  EXPECT_DOUBLE_EQ(second("1700000000000", "1700000000033", 1e-3), 0.033);
  EXPECT_DOUBLE_EQ(second("123456789012345678", "123456789012345679", 1e-9), 1e-9);
}

TEST(TimeText, Dates) {
  const double day = 86400;
  EXPECT_EQ(second("2024-01-05T10:00:00Z", "2024-01-05T10:00:00.5Z"), 0.5);
  EXPECT_EQ(second("2024-01-05 10:00:00.000000+00:00", "2024-01-05 12:00:01+0200"), 1);
  EXPECT_EQ(second("20240105T100000", "20240105T100001.5"), 1.5);
  EXPECT_EQ(second("2024-02-28", "2024-03-01"), 2 * day);
  EXPECT_EQ(second("2024/1/5 10:00", "2024/1/5 10:01"), 60);
  EXPECT_EQ(second("05.01.2024 10:00:00", "06.01.2024 10:00:00"), day);
  EXPECT_EQ(second("5 Jan 2024", "06-Feb-2024"), 32 * day);
  EXPECT_EQ(second("25/01/2024 1:00:00 PM", "01/02/2024 13:00:00"), 7 * day);
  EXPECT_EQ(second("01/25/2024", "02/01/2024"), 7 * day);
  EXPECT_EQ(parse_date("1970-01-02T01:00:00+01:00"), day);
  for (const char* text : {"2024-13-05", "2024-02-30", "2024-01-05T25:00", "2024-01-05T10:61",
                           "2024-01-05x", "2024-01-05T10:00+1", "0.5", "20240105", "01/02/2024"}) {
    EXPECT_FALSE(parse_date(text)) << text;
  }
}

TEST(TimeText, Clocks) {
  EXPECT_EQ(second("00:00:01", "01:02:03.5"), 3723.5);
  EXPECT_EQ(second("00:01", "12:30.25"), 750.25);
  EXPECT_EQ(second("0 days 00:00:00", "1 days 00:00:01.5"), 86401.5);
  EXPECT_TRUE(std::isnan(second("00:00", "00:60")));
}

TEST(TimeText, OneKindAndNoDoubt) {
  TimeText times;
  EXPECT_FALSE(times.seconds("01/02/2024", {}));
  EXPECT_EQ(times.reason("01/02/2024"),
            ": is the day or the month first in it? Write dates as 2024-01-31");
  EXPECT_FALSE(times.seconds("noon", {}));
  EXPECT_EQ(times.reason("noon"), "");
  EXPECT_TRUE(times.seconds("2024-01-05", {}));
  EXPECT_TRUE(times.dated());
  EXPECT_FALSE(times.seconds("3.5", {}));
  EXPECT_EQ(times.reason("3.5"), " as the first one is: a date");
  EXPECT_FALSE(times.seconds("2024-01-05T00:00Z", {}));
}

}  // namespace
}  // namespace lilytank
