// Start poses: a table of `id`, `x`, `y`, `theta`, one row a body, ids 0, 1, ... in order; m and
// rad.
#pragma once
#include <string>
#include <vector>

#include "lilytank/math.hpp"

namespace lilytank {

/// Reads poses from a file's content, as any Table; adds the line of each to `line_numbers`, if
/// that is given. Throws InputError with file, line and column.
std::vector<Pose> parse_poses(const std::string& text, const std::string& file,
                              std::vector<int>* line_numbers = nullptr);

}  // namespace lilytank
