// Wall time: it decides when to report progress and when to save, never what a file holds.
#pragma once
#include <chrono>

namespace lilytank {

/// Time between two reports of progress, s.
inline constexpr double kBetweenReports = 0.2;

class StopWatch {
 public:
  /// Since the construction.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Whether `interval` (s) has passed since the construction, or since this was last true.
  bool due(double interval) {
    const double now = seconds();
    if (now - last_ < interval) return false;
    last_ = now;
    return true;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double last_ = 0;
};

}  // namespace lilytank
