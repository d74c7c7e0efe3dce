// One point in many worlds.
#pragma once
#include <string>
#include <vector>

#include "optimize/source.hpp"

namespace lilytank {

/// A point's mean fitness over `count` >= 2 worlds, from replicate `first` on. They are kept in
/// `file`, from where it resumes; a file of another point is replaced. Throws Stopped.
Incumbent repeated(const Optimization::Source& source, const std::vector<double>& point,
                   std::int64_t first, int count, const std::string& file,
                   const OptimizationOptions& options);

}  // namespace lilytank
