// Paths and values of a scenario, as its layers hold them.
#pragma once
#include <string>
#include <vector>

#include "io/scenario_layers.hpp"

namespace lilytank {

/// Whether a path is rules.<name>.p.
bool is_rule(const Assignment& path);
/// A value that stands in no file.
Assignment named(const std::vector<std::string>& keys, TomlValue value);
/// Where a file has the first of these paths that it has; else the file.
SourcePlace place_in(const std::string& file, const std::vector<std::string>& paths);

}  // namespace lilytank
