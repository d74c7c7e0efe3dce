#include "io/table.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>

#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kMostColumns = 20000;

std::string_view bare(std::string_view cell) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!cell.empty() && blank(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && blank(cell.back())) cell.remove_suffix(1);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') {
    cell.remove_prefix(1), cell.remove_suffix(1);
  }
  return cell;
}

bool not_seen(std::string_view text) {
  static constexpr std::string_view words[] = {"",    "nan",  "na",       "n/a",  "null",
                                               "inf", "none", "infinity", "-inf", "-nan"};
  std::string lower(text.substr(0, 12));
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::find(std::begin(words), std::end(words), lower) != std::end(words);
}

/// `count` digits at `at`; nothing if there are fewer.
std::optional<int> digits(std::string_view text, std::size_t at, std::size_t count) {
  if (at + count > text.size()) return std::nullopt;
  int value = 0;
  for (std::size_t i = at; i < at + count; ++i) {
    if (text[i] < '0' || text[i] > '9') return std::nullopt;
    value = 10 * value + (text[i] - '0');
  }
  return value;
}

}  // namespace

char separator_of(std::string_view line) {
  for (const char c : {'\t', ';', ','}) {
    if (line.find(c) != std::string_view::npos) return c;
  }
  return ' ';
}

void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    if (separator == ' ') {
      line = line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
      if (line.empty()) return;
    }
    const auto end = line.find(separator);
    cells.push_back(bare(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

// "2009-11-01T12:34:56.789", a blank instead of the T, or "20091101T123456.789".
std::optional<double> parse_date(std::string_view text) {
  const std::size_t dash = text.size() > 4 && text[4] == '-' ? 1 : 0;
  const auto year = digits(text, 0, 4), month = digits(text, 4 + dash, 2),
             day = digits(text, 6 + 2 * dash, 2);
  const std::size_t clock = 9 + 2 * dash;
  if (!year || !month || !day || text.size() < clock) return std::nullopt;
  const bool dashes = dash == 0 || text[7] == '-';
  const bool parted = text[clock - 1] == 'T' || text[clock - 1] == ' ';
  if (!dashes || !parted) return std::nullopt;
  const std::size_t colon = text.size() > clock + 2 && text[clock + 2] == ':' ? 1 : 0;
  const auto hour = digits(text, clock, 2), minute = digits(text, clock + 2 + colon, 2);
  const std::size_t seconds = clock + 4 + 2 * colon;
  if (!hour || !minute || seconds > text.size()) return std::nullopt;
  std::string_view rest = text.substr(seconds);
  if (rest.ends_with('Z')) rest.remove_suffix(1);
  const double second = digits(rest, 0, 2) ? parse_number(rest).value_or(-1) : -1;
  const std::chrono::year_month_day date(std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  if (!date.ok() || second < 0 || second >= 61 || *hour > 24 || *minute > 59) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600.0 * *hour + 60.0 * *minute + second;
}

Table::Table(LineSource& lines) : lines_(&lines) {
  std::string_view line;
  bool any = lines.next(line);
  while (any && (trimmed(line).empty() || trimmed(line).front() == '#')) any = lines.next(line);
  if (!any) throw InputError({lines.file(), 1, 1}, "there is no table in it");
  if (trimmed(line).front() == '%') line.remove_prefix(line.find('%') + 1);
  separator_ = separator_of(line);
  split(line);
  const bool numbers = std::all_of(cells_.begin(), cells_.end(), [](std::string_view cell) {
    return parse_number(cell).has_value() || not_seen(cell);
  });
  if (numbers) lines.again();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    names_.push_back(numbers ? std::to_string(i + 1) : std::string(cells_[i]));
  }
  check_names();
}

Table::Table(LineSource& lines, std::vector<std::string> names)
    : lines_(&lines), names_(std::move(names)) {
  std::string_view line;
  if (!content(line)) return;
  separator_ = separator_of(line);
  lines.again();
}

void Table::check_names() const {
  if (names_.size() > kMostColumns) {
    throw InputError(lines_->place(1), std::to_string(names_.size()) + " columns: more than " +
                                           std::to_string(kMostColumns));
  }
  std::vector<std::string_view> sorted(names_.begin(), names_.end());
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end(),
                                        [](auto a, auto b) { return a == b && !a.empty(); });
  if (twice == sorted.end()) return;
  throw InputError(lines_->place(1), "two columns are called '" + std::string(*twice) + "'");
}

int Table::find(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

void Table::split(std::string_view line) {
  row_ = line.data();
  split_cells(line, separator_, cells_);
}

bool Table::content(std::string_view& line) {
  do {
    if (!lines_->next(line)) return false;
  } while (line.empty() || line.front() == '#' || line.front() == '%' || trimmed(line).empty());
  return true;
}

bool Table::next() {
  std::string_view line;
  if (!content(line)) return false;
  split(line);
  // Some writers end rows, or the header alone, with a separator.
  if (cells_.size() == names_.size() + 1 && cells_.back().empty()) cells_.pop_back();
  if (cells_.size() + 1 == names_.size() && names_.back().empty()) cells_.emplace_back();
  if (cells_.size() != names_.size()) {
    throw InputError(lines_->place(1), std::to_string(cells_.size()) + " columns instead of " +
                                           std::to_string(names_.size()));
  }
  return true;
}

double Table::number(int column) const {
  const std::string_view text = cell(column);
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = end == text.data() + text.size();
  if (problem == std::errc() && whole && std::isfinite(value)) return value;
  if (not_seen(text)) return std::numeric_limits<double>::quiet_NaN();
  if (const auto plus = parse_number(text)) return *plus;
  refuse(column, quoted(column) + " is not a number");
}

std::optional<std::int64_t> Table::whole(int column) const {
  const std::string_view text = cell(column);
  constexpr std::int64_t kLargest = 1'000'000'000'000'000;
  if (const auto value = parse_whole(text)) {
    return *value <= kLargest && *value >= -kLargest ? value : std::nullopt;
  }
  const auto value = parse_number(text);
  if (value && std::fabs(*value) <= static_cast<double>(kLargest) && *value == std::floor(*value)) {
    return static_cast<std::int64_t>(*value);
  }
  return std::nullopt;
}

SourcePlace Table::place(int column) const {
  return {lines_->file(), lines_->line(), static_cast<int>(cell(column).data() - row_) + 1};
}

void Table::refuse(int column, const std::string& message) const {
  throw InputError(place(column), message);
}

std::string Table::quoted(int column) const {
  return names_[static_cast<std::size_t>(column)] + " '" + std::string(cell(column).substr(0, 40)) +
         "'";
}

}  // namespace lilytank
