// Copies of the target over the time of a stored run.
#pragma once
#include <string>
#include <vector>

#include "lilytank/run.hpp"

namespace lilytank {

/// How many copies stood when: a staircase.
struct YieldCurve {
  std::vector<double> time;  ///< s, rising; the first is the run's start, the last its end
  std::vector<int> copies;   ///< standing from that time on
  int target_size = 0;       ///< modules in a copy, 0: the run has no target
  int possible = 0;          ///< copies that all modules would make
  /// Copies standing at a time.
  int at(double t) const;
};

/// From the trajectory's markings where it has some (each stored frame counts), else from the rows
/// of the metrics.
YieldCurve yield_of(const StoredRun& run);

/// Numbers of copies for an axis up to `most`: few, rising from 0, the last is `most`; evenly
/// spaced where that can be.
std::vector<int> copy_ticks(int most);

/// A unit of time that suits a length, and the seconds in it.
struct TimeUnit {
  double seconds = 1;
  std::string name = "s";
};
TimeUnit unit_for(double length);
/// "1:02:03" for 3723.4 s.
std::string clock_text(double time);

}  // namespace lilytank
