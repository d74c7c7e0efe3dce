// Values of one point, added up.
#pragma once
#include <cmath>
#include <limits>

#include "search/state_text.hpp"

namespace lilytank {

/// Running mean and variance [Welford 1962]. A value that is not finite makes the mean +infinity
/// for good: such a point is worse than any other.
struct Tally {
  int count = 0;
  double mean = 0;
  double squares = 0;  ///< sum of squared deviations from the mean

  void add(double value) {
    ++count;
    if (!std::isfinite(value) || !std::isfinite(mean)) {
      mean = std::numeric_limits<double>::infinity(), squares = 0;
      return;
    }
    const double off = value - mean;
    mean += off / count;
    squares += off * (value - mean);
  }
  bool usable() const { return count > 0 && std::isfinite(mean); }
  /// Of one value; NaN with fewer than two.
  double variance() const {
    return count > 1 ? squares / (count - 1) : std::numeric_limits<double>::quiet_NaN();
  }
  double standard_error() const { return std::sqrt(variance() / count); }
};

void save_tally(StateWriter& out, const Tally& tally);
Tally load_tally(StateReader& in);

}  // namespace lilytank
