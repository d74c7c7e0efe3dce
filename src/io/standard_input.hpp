// Standard input as a file that can be opened more than once.
#pragma once
#include <string>

namespace lilytank {

/// The name of standard input in messages and reports. Relative paths inside it start from the
/// working directory.
inline const std::string kStandardInput = "<stdin>";

/// The path that opens `file`: `file` itself, but for kStandardInput that of a copy in memory,
/// which takes the place of the process's standard input at the first call. Throws InputError with
/// the system's reason.
std::string openable(const std::string& file);

/// The name of a job that its file does not name: the file's without folder and ending, "stdin" for
/// kStandardInput.
std::string stem_of(const std::string& file);

/// Whether a file holds TOML: by its name, and for kStandardInput by its first line that is neither
/// empty nor a comment, a [table] or `key = value`.
bool is_toml(const std::string& file);

}  // namespace lilytank
