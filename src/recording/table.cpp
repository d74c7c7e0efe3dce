#include "recording/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::string_view kNotSeen[] = {
    "nan", "NaN",  "NAN",      "NA",        "N/A",      "null",      "None", "inf",      "-inf",
    "Inf", "-Inf", "infinity", "-infinity", "Infinity", "-Infinity", "-nan", "-nan(ind)"};

std::string_view bare(std::string_view cell) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!cell.empty() && blank(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && blank(cell.back())) cell.remove_suffix(1);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') {
    cell.remove_prefix(1), cell.remove_suffix(1);
  }
  return cell;
}

bool passed_over(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text.empty() || text.front() == '#';
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

Table::Table(LineSource& lines) : lines_(&lines) {
  std::string_view line;
  do {
    if (!lines.next(line)) throw InputError({lines.file(), 1, 1}, "there is no table in it");
  } while (passed_over(line));
  separator_ = separator_of(line);
  split(line);
  for (const std::string_view name : cells_) names_.emplace_back(name);
}

int Table::find(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

void Table::split(std::string_view line) {
  row_ = line.data();
  split_cells(line, separator_, cells_);
}

bool Table::next() {
  std::string_view line;
  do {
    if (!lines_->next(line)) return false;
  } while (passed_over(line));
  split(line);
  // Some writers end every row, or every row but the header, with a separator.
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
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (problem == std::errc() && end == text.data() + text.size()) {
    return std::isfinite(value) ? value : kNone;
  }
  if (text.empty() ||
      std::find(std::begin(kNotSeen), std::end(kNotSeen), text) != std::end(kNotSeen)) {
    return kNone;
  }
  if (const auto plus = parse_number(text)) return *plus;
  refuse(column, quoted(column) + " is not a number");
}

std::optional<std::int64_t> Table::whole(int column) const {
  const std::string_view text = cell(column);
  if (const auto value = parse_whole(text)) return value;
  const auto value = parse_number(text);
  constexpr double kLargest = 9e15;
  if (value && std::fabs(*value) < kLargest && *value == std::floor(*value)) {
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
  return names_[static_cast<std::size_t>(column)] + " '" + std::string(cell(column)) + "'";
}

}  // namespace lilytank
