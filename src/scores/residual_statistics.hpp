// How innovations scatter: their memory, tails, what their variance goes with, whether neighbours
// share them, what modules differ in, lines in their spectra; and what happens at contact.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "scores/score_plan.hpp"

namespace lilytank {

/// One module in one frame, as scatter parts see it.
struct Seen {
  std::size_t module = 0, index = 0;  ///< identity, and number in the frame
  bool usable = false;                ///< the filter has settled, the module was seen, no contact
  double zx = 0, zy = 0, zt = 0;      ///< innovations by their deviations
  double slip_x = 0, slip_y = 0;      ///< m/s, water relative to the module
  double drag_x = 0, drag_y = 0;      ///< m/s^2, by the expected drag
};

class ResidualStatistic {
 public:
  virtual ~ResidualStatistic() = default;
  virtual std::vector<ScoreEntry> entries() const = 0;
  virtual void add(const PredictedFrame& frame, const std::vector<Seen>& seen) = 0;
  virtual void append_to(std::vector<double>& values, ScoreDetails* details) const = 0;
};

/// Those of a plan, in the order of its entries.
std::vector<std::unique_ptr<ResidualStatistic>> residual_statistics(const ScorePlan& plan);
/// One of them (spectrum.cpp).
std::unique_ptr<ResidualStatistic> spectrum_statistic(const ScorePlan& plan);

}  // namespace lilytank
