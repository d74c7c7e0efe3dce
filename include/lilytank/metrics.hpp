// What a trajectory tells, simulated or recorded.
#pragma once
#include <vector>

#include "lilytank/trajectory.hpp"

namespace lilytank {

/// Which instants count as the start of a displacement.
enum class Origins {
  first,  ///< the first frame only [paper, Eq. 8]
  all,    ///< every frame: less noise, for motion that has settled
};

/// Mean squared displacement by lag.
struct MsdCurve {
  std::vector<double> lag;          ///< s
  std::vector<double> msd;          ///< m^2, mean over bodies and origins
  std::vector<std::int64_t> count;  ///< displacements in each mean
};

/// MSD of bodies [first, first + bodies) at the given lags (in frames, >= 0), from frames at even
/// intervals. A lag longer than the trajectory has count 0 and msd 0.
MsdCurve mean_squared_displacement(const Trajectory& trajectory, int first, int bodies,
                                   const std::vector<int>& lags, Origins origins);

}  // namespace lilytank
