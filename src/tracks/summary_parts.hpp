// The groups of numbers that make up a motion summary. Each adds up tracks and then tells values.
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

class SummaryPart {
 public:
  virtual ~SummaryPart() = default;
  virtual std::vector<SummaryEntry> entries() const = 0;
  virtual void add(const Track& track) = 0;
  /// Of all tracks together, once these were added; for what happens between bodies.
  virtual void add(const Recording& recording) { static_cast<void>(recording); }
  /// One value an entry.
  virtual void tell(std::vector<double>& values) const = 0;
};

/// Seconds as whole frames, at least one.
int frames_of(double seconds, double rate);
/// Logarithm of something positive; of nothing, that of 1e-12.
double log_of(double value);

std::unique_ptr<SummaryPart> displacement_part(const MotionSummary& summary);
std::unique_ptr<SummaryPart> velocity_part(const MotionSummary& summary);
std::unique_ptr<SummaryPart> place_part(const MotionSummary& summary);
std::unique_ptr<SummaryPart> kicks_part(const MotionSummary& summary);
std::unique_ptr<SummaryPart> balance_part(const MotionSummary& summary);
std::unique_ptr<SummaryPart> turning_part(const MotionSummary& summary);
std::unique_ptr<SummaryPart> turning_kicks_part(const MotionSummary& summary);
std::unique_ptr<SummaryPart> neighbours_part(const MotionSummary& summary);

}  // namespace lilytank
