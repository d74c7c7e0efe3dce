// Which files make one recording.
#pragma once
#include <string>
#include <vector>

namespace lilytank {

/// The files that `name` stands for, sorted: itself, or those in a directory (hidden ones left
/// out), or those that fit a pattern with '*' in its last part. Throws InputError if there are
/// none.
std::vector<std::string> files_of(const std::string& name);

}  // namespace lilytank
