#include "io/time_text.hpp"

#include <array>
#include <chrono>
#include <cmath>

#include "io/table.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr double kLargest = 1e12;  // s, of a time

/// Walks along a text.
struct Scanner {
  std::string_view rest;

  bool take(std::string_view word) {
    if (!rest.starts_with(word)) return false;
    rest.remove_prefix(word.size());
    return true;
  }
  bool take_blanks() {
    const auto end = std::min(rest.find_first_not_of(' '), rest.size());
    rest.remove_prefix(end);
    return end > 0;
  }
  /// A whole number of `least` .. `most` digits.
  std::optional<int> digits(std::size_t least, std::size_t most) {
    std::size_t n = 0;
    int value = 0;
    for (; n < most && n < rest.size() && rest[n] >= '0' && rest[n] <= '9'; ++n) {
      value = 10 * value + (rest[n] - '0');
    }
    if (n < least) return std::nullopt;
    rest.remove_prefix(n);
    return value;
  }
  /// What is behind a point or comma, 0 if there is neither.
  std::optional<double> fraction() {
    if (!take(".") && !take(",")) return 0;
    const std::size_t n = std::min(rest.find_first_not_of("0123456789"), rest.size());
    const auto value = parse_number("0." + std::string(rest.substr(0, n)));
    rest.remove_prefix(n);
    return n > 0 ? value : std::nullopt;
  }
};

/// A date of which day and month may be in doubt.
struct Day {
  int year = 0, month = 0, day = 0;
  bool in_doubt = false;   ///< 05/01/2024
  bool slashes = false;    ///< day and month are in either order
  bool day_first = false;  ///< of one with slashes
};

std::optional<int> month_of(Scanner& at) {
  constexpr std::string_view kNames = "janfebmaraprmayjunjulaugsepoctnovdec";
  const auto found = kNames.find(in_small_letters(at.rest.substr(0, 3)));
  if (at.rest.size() < 3 || found == std::string_view::npos || found % 3 != 0) return std::nullopt;
  at.rest.remove_prefix(3);
  return static_cast<int>(found / 3) + 1;
}

// "2024-01-05", "2024/1/5", "20240105" (with a clock behind it).
std::optional<Day> year_first(Scanner& at) {
  const auto year = at.digits(4, 4);
  if (!year) return std::nullopt;
  std::string_view mark;
  for (const std::string_view m : {"-", "/", "."}) {
    if (mark.empty() && at.take(m)) mark = m;
  }
  const std::size_t least = mark.empty() ? 2 : 1;
  const auto month = at.digits(least, 2);
  if (!month || !at.take(mark)) return std::nullopt;
  const auto day = at.digits(least, 2);
  if (!day || (mark.empty() && at.rest.empty())) return std::nullopt;
  return Day{*year, *month, *day, false, false, false};
}

// "05.01.2024" (day first), "25/01/2024", "01/25/2024", "05-Jan-2024", "5 Jan 2024".
std::optional<Day> year_last(Scanner& at, int day_first) {
  const auto first = at.digits(1, 2);
  std::string_view mark;
  for (const std::string_view m : {".", "/", "-", " "}) {
    if (mark.empty() && at.take(m)) mark = m;
  }
  if (!first || mark.empty()) return std::nullopt;
  const auto named = month_of(at);
  const auto second = named ? named : at.digits(1, 2);
  if (!second || !at.take(mark)) return std::nullopt;
  const auto year = at.digits(4, 4);
  if (!year) return std::nullopt;
  if (named || mark == ".") return Day{*year, *second, *first, false, false, true};
  if (mark == " ") return std::nullopt;
  const bool known = *first > 12 || *second > 12 || day_first >= 0;
  const bool day = *first > 12 || (*second <= 12 && day_first == 1);
  return day ? Day{*year, *second, *first, !known, true, true}
             : Day{*year, *first, *second, !known, true, false};
}

// "10:00", "10:00:00.5", "100000.5", "3:05:10 PM"; s.
std::optional<double> clock_of_day(Scanner& at) {
  const auto hour = at.digits(1, 2);
  if (!hour) return std::nullopt;
  const bool colons = at.take(":");
  const auto minute = at.digits(2, 2);
  if (!minute || *minute > 59) return std::nullopt;
  double second = 0;
  if (colons ? at.take(":") : !at.rest.empty() && at.rest[0] >= '0' && at.rest[0] <= '9') {
    const auto whole = at.digits(2, 2);
    const auto fraction = at.fraction();
    if (!whole || !fraction || *whole > 60) return std::nullopt;
    second = *whole + *fraction;
  }
  int h = *hour;
  Scanner behind = at;
  behind.take_blanks();
  const std::string half = in_small_letters(behind.rest.substr(0, 2));
  if (half == "am" || half == "pm") {
    if (h < 1 || h > 12) return std::nullopt;
    h = h % 12 + (half == "pm" ? 12 : 0);
    at = behind, at.rest.remove_prefix(2);
  }
  if (h > 24) return std::nullopt;
  return 3600.0 * h + 60.0 * *minute + second;
}

/// What a zone is ahead of UTC, in s; nothing if the text is no zone.
std::optional<double> zone_of(Scanner at) {
  at.take_blanks();
  if (at.rest == "Z" || at.rest == "z" || at.rest == "UTC" || at.rest == "GMT") return 0;
  const bool ahead = at.take("+"), behind = !ahead && (at.take("-") || at.take("\u2212"));
  if (!ahead && !behind) return std::nullopt;
  const auto hour = at.digits(2, 2);
  at.take(":");
  const int minute = at.rest.empty() ? 0 : at.digits(2, 2).value_or(99);
  if (!hour || *hour > 24 || minute > 59 || !at.rest.empty()) return std::nullopt;
  return (ahead ? 1 : -1) * (3600.0 * *hour + 60.0 * minute);
}

struct Date {
  double seconds = 0;  ///< since 1970
  bool zoned = false;
  Day day;
};

std::optional<Date> date_of(std::string_view text, int day_first) {
  Scanner at{text};
  auto day = year_first(at);
  if (!day) at.rest = text, day = year_last(at, day_first);
  if (!day) return std::nullopt;
  const std::chrono::year_month_day date(std::chrono::year(day->year),
                                         std::chrono::month(static_cast<unsigned>(day->month)),
                                         std::chrono::day(static_cast<unsigned>(day->day)));
  if (!date.ok()) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  Date out{86400.0 * static_cast<double>(days), false, *day};
  if (at.rest.empty()) return out;
  at.take(",");
  if (!at.take("T") && !at.take("t") && !at.take_blanks()) return std::nullopt;
  const auto clock = clock_of_day(at);
  if (!clock) return std::nullopt;
  out.seconds += *clock;
  if (at.rest.empty()) return out;
  const auto zone = zone_of(at);
  if (!zone) return std::nullopt;
  out.seconds -= *zone, out.zoned = true;
  return out;
}

// "h:m:s", "m:s", both with a fraction; "2 days 03:00:00" as pandas writes spans; s.
std::optional<double> clock_of(std::string_view text) {
  Scanner at{text};
  double days = 0;
  if (const auto behind = text.find(" day"); behind != std::string_view::npos) {
    const auto count = at.digits(1, 6);
    if (!count || (!at.take(" days") && !at.take(" day")) || !at.take_blanks()) return std::nullopt;
    days = *count;
  }
  std::array<int, 3> parts{};
  std::size_t n = 0;
  do {
    const auto part = at.digits(1, n == 0 ? 7 : 2);
    if (!part || n == parts.size() || (n > 0 && *part > 59)) return std::nullopt;
    parts[n++] = *part;
  } while (at.take(":"));
  const auto fraction = at.fraction();
  if (n < 2 || !fraction || !at.rest.empty()) return std::nullopt;
  const double whole =
      n == 3 ? 3600.0 * parts[0] + 60.0 * parts[1] + parts[2] : 60.0 * parts[0] + parts[1];
  return 86400 * days + whole + *fraction;
}

/// The unit of a count since 1970 that is a date between 1990 and 2100 in it; 0 if there is none.
double epoch_unit(double value) {
  constexpr double kFrom = 631152000, kTo = 4102444800;  // s
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    if (value * unit >= kFrom && value * unit <= kTo) return unit;
  }
  return 0;
}

/// A number as a whole number and the rest behind its point.
std::pair<std::int64_t, double> parted(std::string_view text, double value) {
  const auto point = text.find('.');
  if (const auto whole = parse_whole(text.substr(0, point))) {
    if (point == std::string_view::npos) return {*whole, 0};
    const auto rest = parse_number("0" + std::string(text.substr(point)));
    if (rest && *rest < 1) return {*whole, *whole < 0 ? -*rest : *rest};
  }
  constexpr double kMost = 4e18;
  if (std::fabs(value) > kMost) return {0, value};
  const double whole = std::trunc(value);
  return {static_cast<std::int64_t>(whole), value - whole};
}

}  // namespace

std::optional<double> parse_date(std::string_view text) {
  const auto date = date_of(text, -1);
  return date && !date->day.in_doubt ? std::optional(date->seconds) : std::nullopt;
}

std::optional<double> TimeText::number(std::string_view text, std::optional<double> unit) {
  const auto value = parse_number(text);
  if (!value) return std::nullopt;
  if (kind_ == Kind::none) {
    constexpr double kEpoch = 1e8, kManyDigits = 1e11;
    const double found = unit ? 0 : epoch_unit(*value);
    unit_ = found > 0 ? found : unit.value_or(1);
    const double size = std::fabs(*value);
    const bool epoch = found > 0 || size * unit_ >= kEpoch || size >= kManyDigits;
    kind_ = epoch ? Kind::epoch : Kind::number;
    if (epoch) std::tie(whole_, first_) = parted(text, *value);
  }
  if (kind_ == Kind::number) return *value * unit.value_or(1);
  const auto [whole, rest] = parted(text, *value);
  const double apart = static_cast<double>(whole) - static_cast<double>(whole_);
  const bool exact = std::fabs(apart) < 9e18;
  return ((exact ? static_cast<double>(whole - whole_) : apart) + (rest - first_)) * unit_;
}

std::optional<double> TimeText::seconds(std::string_view text, std::optional<double> unit) {
  const bool first = kind_ == Kind::none;
  if (first || kind_ == Kind::number || kind_ == Kind::epoch) {
    if (const auto value = number(text, unit)) return value;
    if (!first) return std::nullopt;
  }
  if (first || kind_ == Kind::clock) {
    if (const auto clock = clock_of(text)) {
      kind_ = Kind::clock;
      return clock;
    }
    if (!first) return std::nullopt;
  }
  const auto date = date_of(text, day_first_);
  if (!date || date->day.in_doubt) return std::nullopt;
  const Kind kind = date->zoned ? Kind::zoned_date : Kind::date;
  if (first) kind_ = kind, first_ = date->seconds;
  if (kind != kind_) return std::nullopt;
  if (date->day.slashes) {
    if (day_first_ >= 0 && date->day.day_first != (day_first_ == 1)) return std::nullopt;
    day_first_ = date->day.day_first ? 1 : 0;
  }
  return date->seconds - first_;
}

std::string TimeText::reason(std::string_view text) const {
  const auto date = date_of(text, day_first_);
  if (date && date->day.in_doubt) {
    return ": is the day or the month first in it? Write dates as 2024-01-31";
  }
  if (date && date->day.slashes && day_first_ >= 0) {
    return std::string(": the ") + (day_first_ == 1 ? "day" : "month") + " comes first in others";
  }
  constexpr std::string_view kKinds[] = {"",       "a number",           "a count since 1970",
                                         "a date", "a date with a zone", "a clock's time"};
  const bool other = date || clock_of(text) || parse_number(text);
  if (!other || kind_ == Kind::none) return "";
  return " as the first one is: " + std::string(kKinds[static_cast<std::size_t>(kind_)]);
}

double time_of(const Table& table, int column, TimeText& times, std::optional<double> unit) {
  const std::string_view text = table.plain(column);
  const auto value = times.seconds(text, unit);
  if (!value) table.refuse(column, table.quoted(column) + " is not a time" + times.reason(text));
  if (std::fabs(*value) > kLargest) table.refuse(column, table.quoted(column) + " is too large");
  return *value;
}

}  // namespace lilytank
