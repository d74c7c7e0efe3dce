// Files that appear whole or not at all, and whole files read.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

/// Writes `content` to a new temporary file beside `file`, hands it to the disk, renames it. Throws
/// InputError with the system's reason; the file is then as it was before. Permissions stay, a link
/// is followed and stays a link, and what is no regular file (a device, a pipe) is written to and
/// stays what it is. No other file changes. Any number of processes may write one file at once:
/// it is one's or another's, and whole.
void write_atomically(const std::string& file, std::string_view content);

/// Whether a file cannot be replaced without losing what it holds: a regular file that exists with
/// other contents than `content`.
bool holds_other(const std::string& file, std::string_view content);
/// Throws InputError: a file exists with other contents, and --force replaces it.
[[noreturn]] void refuse_to_replace(const std::string& file);

using NamedContents = std::vector<std::pair<std::string, std::string>>;

/// Writes files that belong together, pairs of path and content: all are complete before the first
/// one is renamed, and of several processes that write the same files one leaves all of them.
/// Throws InputError; unless a renaming failed, no file has changed then.
void write_together(const NamedContents& files);

/// Writes results by write_together(). Unless `force`, throws InputError, and writes none, if one
/// of the files exists with other contents: a repeated command writes the same ones.
void write_results(const NamedContents& files, bool force);

/// Creates a file as write_atomically() does; false, and nothing changes, if it exists, for exactly
/// one of several processes that try at once succeeds. Throws InputError.
bool create_atomically(const std::string& file, std::string_view content);

/// Makes a directory and those it lies in, where they are absent. Throws InputError.
void make_directory(const std::string& dir);

/// Writes files, pairs of name and content, into a directory, made if absent, by write_together().
/// Returns their names. Throws InputError.
std::vector<std::string> write_files(const std::string& dir, const NamedContents& files);

/// The whole content of a file. Throws InputError, at `asked_by` where that is known.
std::string read_whole(const std::string& file, const SourcePlace& asked_by = {});

/// Throws InputError, with the nearest name, if there is no file or directory of this name.
void require_path(const std::string& path);

/// Writes to an open file; 0, or errno's value.
int write_all(int descriptor, std::string_view content);

/// "cannot read 'x.csv': No such file or directory", with the reason for errno's value `number`.
std::string system_problem(const std::string& what, const std::string& file, int number);

}  // namespace lilytank
