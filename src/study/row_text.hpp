// A finished run as one line of a rows file, and back.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "lilytank/study.hpp"

namespace lilytank {

/// The first line of every rows file, with its end.
std::string row_header();
/// Without its checksum. `study` is the plan's identity. Commas in the note become semicolons.
std::string row_line(const RunRow& row, std::uint64_t study);

/// The rows of a file that belong to `plan`, with the axes' values filled in. A last line that was
/// cut, by a kill or because another process is just writing it, is left out. `foreign` becomes
/// true if there is a row of another study. Throws InputError on damage.
std::vector<RunRow> rows_from(std::string_view text, const std::string& file, const StudyPlan& plan,
                              bool& foreign);

/// "ok" or "diverged".
std::string status_word(RunStatus status);

}  // namespace lilytank
