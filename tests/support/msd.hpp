// Mean squared displacements in frames, for tests.
#pragma once
#include <cmath>

#include "lilytank/metrics.hpp"

namespace lilytank {

/// Mean squared displacement by lag.
struct MsdCurve {
  /// Lags, s.
  std::vector<double> lag;
  /// Mean over bodies and origins, m^2.
  std::vector<double> msd;
  std::vector<std::int64_t> count;  ///< displacements in each mean
  /// That have such displacements.
  std::vector<std::int64_t> tracks;
};
/// MSD of all bodies at the given lags (in frames, >= 0). A lag that no track is long enough for
/// has count 0 and msd 0.
inline MsdCurve mean_squared_displacement(const Recording& recording, const std::vector<int>& lags,
                                          Origins origins) {
  MsdCurve curve;
  for (const int lag : lags) curve.lag.push_back(lag / recording.rate);
  const BodySums sums = squared_displacements(recording, curve.lag, origins);
  for (std::size_t i = 0; i < lags.size(); ++i) {
    double sum = 0, count = 0;
    for (std::size_t at = i; at < sums.sum.size(); at += lags.size()) {
      sum += sums.sum[at], count += sums.weight[at];
    }
    curve.msd.push_back(count > 0 ? sum / count : 0);
    curve.count.push_back(std::llround(count));
  }
  curve.tracks = sums.tracks;
  return curve;
}

}  // namespace lilytank
