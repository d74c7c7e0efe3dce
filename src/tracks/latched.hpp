// Which modules of a stored run move as one.
#pragma once
#include <vector>

#include "lilytank/trajectory.hpp"

namespace lilytank {

/// [module] The first module of the assembly that a module belongs to in half of the frames or
/// more; -1: it is alone. Pairs of one assembly are joined in chains. Looks at 2000 frames at most.
std::vector<int> lasting_assemblies(const Trajectory& trajectory);

}  // namespace lilytank
