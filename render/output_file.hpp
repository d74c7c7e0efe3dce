// Files that appear whole or not at all.
#pragma once
#include <string>

namespace lilytank {

/// A name beside `file` to write to until the content is complete; another process would choose
/// another one.
std::string unfinished_name(const std::string& file);
/// Throws InputError if nothing can be written beside `file`, before much work is done for it.
void require_writable(const std::string& file);
/// Gives a finished file its name. Throws InputError, and removes it, where that fails.
void publish(const std::string& unfinished, const std::string& file);
/// Writes `bytes` as `file`. Throws InputError with the system's reason where that fails.
void write_whole(const std::string& file, const std::string& bytes);

}  // namespace lilytank
