#include "recording/column_cells.hpp"

#include <algorithm>
#include <cmath>

#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr double kLargest = 1e12;

/// The column that differs by large and small letters alone, or the nearest word.
std::string nearest(const std::string& wanted, const Table& table) {
  for (const std::string& name : table.names()) {
    if (in_small_letters(name) != in_small_letters(wanted)) continue;
    return " - did you mean '" + name + "'?";
  }
  return did_you_mean(wanted, table.names());
}

}  // namespace

void refuse_missing(const Table& table, const std::vector<std::string>& names) {
  std::string near;
  for (const std::string& name : names) {
    if (near.empty()) near = nearest(name, table);
  }
  const std::string wanted =
      joined(names, " or ", [](const std::string& name) { return "'" + name + "'"; });
  throw InputError(
      {table.file(), table.header_line(), 1},
      "there is no column " + wanted + near + "; there are " + short_list(table.names()));
}

int find_column(const Table& table, const std::string& own, const std::vector<std::string>& names) {
  if (own == "-") return -1;
  if (!own.empty()) {
    const int found = table.find(own);
    if (found < 0) refuse_missing(table, {own});
    return found;
  }
  for (const std::string& name : names) {
    if (const int found = table.find(name); found >= 0) return found;
  }
  return -1;
}

int find_frame(const Table& table, const std::string& own, RecordingFormat format) {
  const int found = find_column(table, own, columns_of(format).frame);
  return found < 0 && own.empty() ? find_role(table.names(), ColumnRole::frame) : found;
}

double bounded(const Table& table, int column) {
  const double value = table.number(column);
  if (std::fabs(value) > kLargest) table.refuse(column, table.quoted(column) + " is too large");
  return value;
}

std::int64_t whole_cell(const Table& table, int column) {
  const auto value = table.whole(column);
  if (!value) table.refuse(column, table.quoted(column) + " is not a whole number");
  return *value;
}

void list_unused(const Table& table, const std::vector<int>& used, Sightings& out) {
  out.unused.clear();
  const auto& names = table.names();
  for (int c = 0; c < static_cast<int>(names.size()); ++c) {
    const std::string& name = names[c];
    if (std::find(used.begin(), used.end(), c) == used.end() && !name.empty()) {
      out.unused.push_back(name);
    }
  }
}

void add_hint(const std::string& hint, Sightings& out) {
  if (std::find(out.hints.begin(), out.hints.end(), hint) == out.hints.end()) {
    out.hints.push_back(hint);
  }
}

}  // namespace lilytank
