// Finding and reading the columns of a recording's table.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "io/table.hpp"
#include "recording/column_names.hpp"
#include "recording/sightings.hpp"

namespace lilytank {

/// The column that the user names (`own`), or the first one that has one of the format's names; -1
/// if there is none or `own` is "-". Throws InputError where the user's column is not there.
int find_column(const Table& table, const std::string& own, const std::vector<std::string>& names);
/// The column of frames: the user's, the format's, or one that is called so; -1 if there is none.
int find_frame(const Table& table, const std::string& own, RecordingFormat format);
/// Throws InputError: there is no column of these names.
[[noreturn]] void refuse_missing(const Table& table, const std::vector<std::string>& names);

/// A cell as a number; NaN where it is a word for "not seen". Throws InputError: no number, or
/// beyond 1e12, which is no length or angle and would overflow later.
double bounded(const Table& table, int column);
/// A whole number. Throws InputError.
std::int64_t whole_cell(const Table& table, int column);
/// Names the columns of a table that are none of `used` in out.unused.
void list_unused(const Table& table, const std::vector<int>& used, Sightings& out);
/// Adds a hint, once.
void add_hint(const std::string& hint, Sightings& out);

}  // namespace lilytank
