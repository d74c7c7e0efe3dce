// The files that scenarios are made from.
#pragma once
#include <string>
#include <vector>

#include "io/scenario_layers.hpp"

namespace lilytank {

/// `files`, and the files that layers come from or name, each once: those under a file's `base`,
/// rulesets, flows, poses.
std::vector<std::string> with_files_of(const std::vector<Layer>& layers,
                                       std::vector<std::string> files);

}  // namespace lilytank
