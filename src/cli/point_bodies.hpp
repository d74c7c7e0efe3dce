// Experiments of point bodies, given to a verb that knows only our tank.
#pragma once
#include <string>
#include <vector>

namespace lilytank::cli {

/// Throws InputError if one of the files is an experiment that lilytank diagnose alone reads,
/// rather than let its first key be called unknown.
void refuse_point_bodies(const std::vector<std::string>& files);

}  // namespace lilytank::cli
