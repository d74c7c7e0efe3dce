// A file that another program writes: it has another name until it is complete.
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

}  // namespace lilytank
