#include "io/csv.hpp"

#include <algorithm>

#include "io/file_digest.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

std::vector<std::string_view> split(std::string_view row) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = row.find(',');
    cells.push_back(row.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    row.remove_prefix(comma + 1);
  }
}

std::string_view without_return(std::string_view line) {
  return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string file,
                     const std::vector<std::string>& headers)
    : text_(text), file_(std::move(file)) {
  const auto end = std::min(text_.find('\n'), text_.size());
  const std::string_view first = without_return(text_.substr(0, end));
  const auto found = std::find(headers.begin(), headers.end(), first);
  if (found == headers.end()) {
    throw InputError({file_, 1, 1}, "the first line is not \"" + headers.front() + "\"");
  }
  header_ = static_cast<std::size_t>(found - headers.begin());
  for (const std::string_view name : split(*found)) names_.emplace_back(name);
  at_ = std::min(end + 1, text_.size());
}

bool CsvReader::next() {
  if (at_ >= text_.size()) return false;
  const auto stop = std::min(text_.find('\n', at_), text_.size());
  const std::string_view row = without_return(text_.substr(at_, stop - at_));
  row_ = row.data(), cells_ = split(row);
  at_ = stop + 1;
  ++line_;
  if (cells_.size() != names_.size()) {
    throw InputError({file_, line_, 1}, std::to_string(cells_.size()) + " columns instead of " +
                                            std::to_string(names_.size()));
  }
  if (names_.back() == kChecksumColumn.substr(1)) check_row(row);
  return true;
}

void CsvReader::check_row(std::string_view row) const {
  const auto cells = row.substr(0, row.size() - cells_.back().size() - 1);
  if (checksum(cells) == cells_.back()) return;
  throw InputError({file_, line_, 1},
                   "the row was changed since it was written (its checksum does not fit); remove "
                   "the row to have it computed again, or begin again with --force");
}

double CsvReader::number(std::size_t column) const {
  const auto value = parse_number(cells_[column]);
  if (!value) refuse(column, quoted(column) + " is not a finite number");
  return *value;
}

float CsvReader::float_number(std::size_t column) const {
  const auto value = parse_float(cells_[column]);
  if (!value) refuse(column, quoted(column) + " is not a finite number");
  return *value;
}

std::int64_t CsvReader::whole(std::size_t column, std::int64_t low, std::int64_t high) const {
  const auto value = parse_whole(cells_[column]);
  if (!value) refuse(column, quoted(column) + " is not a whole number");
  if (*value < low || *value > high) {
    refuse(column,
           quoted(column) + " is outside " + std::to_string(low) + " .. " + std::to_string(high));
  }
  return *value;
}

SourcePlace CsvReader::place(std::size_t column) const {
  return {file_, line_, static_cast<int>(cells_[column].data() - row_) + 1};
}

void CsvReader::refuse(std::size_t column, const std::string& message) const {
  throw InputError(place(column), message);
}

std::string CsvReader::quoted(std::size_t column) const {
  return names_[column] + " '" + std::string(cells_[column]) + "'";
}

std::string_view whole_lines(std::string_view text) {
  return text.substr(0, text.rfind('\n') + 1);
}

}  // namespace lilytank
