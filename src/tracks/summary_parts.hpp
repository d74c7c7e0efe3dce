// The groups of numbers that make up a motion summary. Each sums over tracks.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "lilytank/motion_summary.hpp"

namespace lilytank {

/// A sum and how much it is of.
struct MeanSum {
  double sum = 0, weight = 0;
  /// Not finite values, of frames in which a body was not seen, do not count.
  void add(double value) {
    if (value - value == 0) sum += value, weight += 1;
  }
  double mean() const { return weight > 0 ? sum / weight : 0; }
};

/// A statistic with its entry.
struct SummaryValue {
  std::string group, name;
  double value = 0;
};
using SummaryValues = std::vector<SummaryValue>;

class SummaryPart {
 public:
  virtual ~SummaryPart() = default;
  virtual void add(const Track& track) = 0;
  /// Of all tracks together, before each of them; for what happens between bodies.
  virtual void add(const Recording&) {}
  /// Appends the statistics of what was added. Their entries do not depend on it.
  virtual void report(SummaryValues& out) const = 0;
};
using SummaryParts = std::vector<std::unique_ptr<SummaryPart>>;

/// Seconds as whole frames, at least one.
int frames_of(double seconds, double rate);
/// Logarithm of something positive; of nothing, that of 1e-12.
double log_of(double value);

void add_motion_parts(const MotionSummary& summary, SummaryParts& out);
void add_balance_parts(const MotionSummary& summary, SummaryParts& out);

}  // namespace lilytank
