#include "io/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {

Table::Table(LineSource& lines, const TableLayout& layout)
    : lines_(lines), layout_(layout), header_(read_table_header(lines_, layout)) {
  find_decimals();
  find_twins();
}

void Table::rename(std::vector<std::string> names) {
  header_.names = std::move(names);
  find_twins();
}

int Table::find(std::string_view name) const {
  const auto found = std::find(names().begin(), names().end(), name);
  if (found != names().end()) return static_cast<int>(found - names().begin());
  const auto number = header_.in_comment ? parse_whole(name) : std::nullopt;
  const bool there = number && *number >= 1 && *number <= static_cast<int>(names().size());
  return there ? static_cast<int>(*number - 1) : -1;
}

std::vector<int> Table::fixed_columns(const std::vector<std::string>& wanted,
                                      const std::string& what) const {
  const SourcePlace where{file(), header_.line, 1};
  const std::string all = "; " + what + " has the columns " + joined(wanted, ",");
  std::vector<int> out;
  for (const std::string& name : wanted) {
    out.push_back(find(name));
    if (out.back() >= 0) continue;
    throw InputError(where,
                     "there is no column '" + name + "'" + did_you_mean(name, names()) + all);
  }
  for (const std::string& name : names()) {
    if (name.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end()) continue;
    throw InputError(where,
                     "column '" + name + "' is not known" + did_you_mean(name, wanted) + all);
  }
  return out;
}

// From the first rows: a decimal comma in any of them is one in all. Where commas separate cells,
// none is a decimal comma.
void Table::find_decimals() {
  constexpr std::size_t kRows = 200;
  decimal_comma_ = layout_.decimal_comma.value_or(false);
  if (layout_.decimal_comma || header_.separator == ',') return;
  for (std::size_t i = 0; i < kRows && !decimal_comma_; ++i) {
    const TableLines::Line* line = lines_.ahead(i);
    if (line == nullptr) return;
    if (line->text.find(',') == std::string::npos) continue;
    split_cells(line->text, header_.separator, cells_, store_, {file(), line->number, 1});
    decimal_comma_ = std::any_of(cells_.begin(), cells_.end(), [](std::string_view cell) {
      return comma_in(cell) == Comma::decimal;
    });
  }
}

void Table::find_twins() {
  twins_.clear();
  std::vector<int> order(names().size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto name = [&](int column) -> const std::string& { return names()[column]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return name(a) < name(b); });
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    if (name(order[i]) != name(order[first])) first = i;
    if (i > first && !name(order[i]).empty()) twins_.push_back({order[first], order[i]});
  }
}

void Table::check_twins(int column) const {
  for (const Twins& twins : twins_) {
    if (twins.first != column) continue;
    const std::string_view one = cells_[column];
    const std::string_view other = cells_[twins.other];
    const auto a = parse_number(one), b = parse_number(other);
    if (one == other || (a && a == b) || (is_not_seen(one) && is_not_seen(other))) continue;
    throw InputError({file(), line(), 0}, "two columns are called '" + names()[column] + "' (" +
                                              std::to_string(column + 1) + " and " +
                                              std::to_string(twins.other + 1) + "), and differ: '" +
                                              std::string(one) + "', '" + std::string(other) + "'");
  }
}

/// Splits a line; false if it is a row of empty cells.
bool Table::split(std::string_view line) {
  row_ = line;
  split_cells(line, header_.separator, cells_, store_, {file(), this->line(), 1});
  const auto empty = [](std::string_view cell) { return cell.empty(); };
  return cells_.empty() || !cells_[0].empty() || !std::all_of(cells_.begin(), cells_.end(), empty);
}

/// Whether a line is a row; splits it.
bool Table::row(std::string_view line) {
  if (line.empty() || trimmed(line).empty()) return false;
  const bool comment = line.front() == '#' || line.front() == '%';
  if (!split(line)) {
    ++empty_rows_;
    return false;
  }
  const std::size_t count = names().size();
  // Some writers end rows, or the header alone, with separators.
  while (cells_.size() > count && cells_.back().empty()) cells_.pop_back();
  while (cells_.size() < count && names()[cells_.size()].empty() && !comment) {
    cells_.emplace_back();
  }
  if (comment && cells_.size() != count) {
    ++comment_lines_;
    return false;
  }
  return true;
}

bool Table::next() {
  std::string_view line;
  empty_rows_ = 0;
  do {
    if (!lines_.next(line)) return false;
  } while (!row(line));
  const std::size_t count = names().size();
  if (cells_.size() == count) return true;
  std::string hint;
  if (header_.separator == ',' && cells_.size() > count) {
    hint = ": decimal commas need ';' or tabs between the cells";
  }
  if (count == 1 && !header_.text.empty()) {
    hint = ": header_line = N says in which line the names are, if not in line " +
           std::to_string(header_.line);
  }
  throw InputError(
      {file(), this->line(), 1},
      std::to_string(cells_.size()) + " columns instead of " + std::to_string(count) + hint);
}

std::string_view Table::plain(int column) const {
  const std::string_view text = cell(column);
  if (!decimal_comma_) return text;
  const Comma comma = comma_in(text);
  if (comma != Comma::decimal && comma != Comma::ambiguous) return text;
  plain_ = text;
  plain_[text.find(',')] = '.';
  return plain_;
}

// Beside decimal commas, a point may part thousands: "1.234" is no number there.
std::optional<double> Table::value(int column) const {
  const std::string_view text = plain(column);
  if (decimal_comma_ && text.data() != plain_.data()) {
    std::string commas(text);
    std::replace(commas.begin(), commas.end(), '.', ',');
    if (comma_in(commas) == Comma::ambiguous) return std::nullopt;
  }
  return parse_number(text);
}

double Table::number(int column) const {
  if (!decimal_comma_) {
    const std::string_view text = cell(column);
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = end == text.data() + text.size();
    if (problem == std::errc() && whole && std::isfinite(value)) return value;
  }
  if (const auto found = value(column)) return *found;
  if (not_seen(column)) return std::numeric_limits<double>::quiet_NaN();
  refuse(column, quoted(column) + " is not a number" + comma_hint(cell(column)));
}

double Table::finite(int column) const {
  const double value = number(column);
  if (std::isnan(value)) refuse(column, quoted(column) + " is not a finite number");
  return value;
}

std::string Table::comma_hint(std::string_view text) const {
  if (decimal_comma_ && parse_number(text)) {
    return ": other numbers have a decimal comma, and this point may part thousands; "
           "decimal_comma = false takes it for a decimal point";
  }
  switch (comma_in(text)) {
    case Comma::none:
      return "";
    case Comma::thousands:
      return ": write it without separators of thousands";
    default:
      return ": if the comma is a decimal comma, decimal_comma = true reads it";
  }
}

std::optional<std::int64_t> Table::whole(int column) const {
  const std::string_view text = cell(column);
  constexpr std::int64_t kLargest = 1'000'000'000'000'000;
  if (const auto value = parse_whole(text)) {
    return *value <= kLargest && *value >= -kLargest ? value : std::nullopt;
  }
  const auto number = value(column);
  if (number && std::fabs(*number) <= static_cast<double>(kLargest) &&
      *number == std::floor(*number)) {
    return static_cast<std::int64_t>(*number);
  }
  return std::nullopt;
}

SourcePlace Table::place(int column) const {
  const char* at = cells_[column].data();
  const bool inside = at >= row_.data() && at <= row_.data() + row_.size();
  return {file(), line(), inside ? static_cast<int>(at - row_.data()) + 1 : 0};
}

void Table::refuse(int column, const std::string& message) const {
  throw InputError(place(column), message);
}

std::string Table::quoted(int column) const {
  return names()[column] + " '" + std::string(cells_[column].substr(0, 40)) + "'";
}

}  // namespace lilytank
