// Times as tables hold them: numbers, counts since 1970, clocks and dates.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lilytank {

class Table;

/// Reads the times of one recording in seconds. The first time fixes the kind for all others:
/// - a number, times the unit (1 s if none is given);
/// - a count since 1970 in s, ms, us or ns: 1e8 s or more after the unit, or a number that is a
/// date
///   between 1990 and 2100 in one of these units where no unit is given;
/// - a date: ISO 8601 with or without zone ("2024-01-05 10:00:00.5+02:00", "20240105T100000Z",
///   "2024-01-05"), "05.01.2024 10:00", "5 Jan 2024", or "25/01/2024" where one of the two numbers
///   before the year is above 12;
/// - a clock: "h:m:s", "m:s", "1 days 02:00:00".
/// Counts since 1970 and dates count from the first one, exactly: no digit is lost to their size.
class TimeText {
 public:
  enum class Kind : std::uint8_t { none, number, epoch, date, zoned_date, clock };
  /// Seconds; nothing where the text is no time, or is of another kind than the first time.
  /// `unit`: s per unit of numbers.
  std::optional<double> seconds(std::string_view text, std::optional<double> unit);
  /// Why seconds() gave nothing, as ": ..." to follow "... is not a time", or "".
  std::string reason(std::string_view text) const;
  /// Of the first time; none before it.
  Kind kind() const { return kind_; }
  /// s per unit of a count since 1970.
  double unit() const { return unit_; }
  /// Whether times count from the first one.
  bool dated() const {
    return kind_ != Kind::none && kind_ != Kind::number && kind_ != Kind::clock;
  }

 private:
  std::optional<double> number(std::string_view text, std::optional<double> unit);
  Kind kind_ = Kind::none;
  std::int64_t whole_ = 0;  ///< of the first count since 1970
  double first_ = 0;        ///< s of the first date; of a count, what is behind its point
  double unit_ = 1;         ///< s of a count since 1970
  int day_first_ = -1;      ///< 1: 25/01/2024, 0: 01/25/2024, -1: not known yet
};

/// Seconds of a date since 1970, UTC where a zone is given; nothing if it is no date.
std::optional<double> parse_date(std::string_view text);

/// The cell of a table as a time. Throws InputError: no time, or beyond 1e12 s.
double time_of(const Table& table, int column, TimeText& times, std::optional<double> unit);

}  // namespace lilytank
