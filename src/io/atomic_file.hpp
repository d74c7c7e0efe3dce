// Files that appear whole or not at all, and whole files read.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

/// Writes `content` under a temporary name beside `file`, hands it to the disk, renames it. Throws
/// InputError with the system's reason; the file is then as it was before. A link is followed and
/// stays a link; what is no regular file (a device, a pipe) is written to and stays what it is.
void write_atomically(const std::string& file, std::string_view content);

/// Makes a directory and those it lies in, where they are absent. Throws InputError.
void make_directory(const std::string& dir);

/// Writes files, pairs of name and content, into a directory, made if absent; each atomically.
/// Returns their names. Throws InputError.
std::vector<std::string> write_files(const std::string& dir,
                                     const std::vector<std::pair<std::string, std::string>>& files);

/// The whole content of a file. Throws InputError, at `asked_by` where that is known.
std::string read_whole(const std::string& file, const SourcePlace& asked_by = {});

/// "cannot read 'x.csv': No such file or directory", with the reason for errno's value `number`.
std::string system_problem(const std::string& what, const std::string& file, int number);

}  // namespace lilytank
