// How innovations scatter: their memory, tails, what their variance goes with, whether neighbours
// share them, what modules differ in, lines in their spectra; and what happens at contact.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "finder/score_plan.hpp"

namespace lilytank {

/// One module in one frame, as scatter parts see it.
struct Seen {
  std::size_t module = 0, index = 0;  ///< identity, and number in the frame
  bool usable = false;                ///< the filter has settled, the module was seen, no contact
  double zx = 0, zy = 0, zt = 0;      ///< innovations by their deviations
  double slip_x = 0, slip_y = 0;      ///< m/s, water relative to the module
  double drag_x = 0, drag_y = 0;      ///< m/s^2, by the expected drag
};

class ScatterPart {
 public:
  virtual ~ScatterPart() = default;
  virtual std::vector<ScoreEntry> entries() const = 0;
  virtual void add(const PredictedFrame& frame, const std::vector<Seen>& seen) = 0;
  virtual void tell(std::vector<double>& values, ScoreDetails* details) const = 0;
};

std::unique_ptr<ScatterPart> memory_part(const ScorePlan& plan);
std::unique_ptr<ScatterPart> variance_part(const ScorePlan& plan);
std::unique_ptr<ScatterPart> neighbour_part(const ScorePlan& plan);
std::unique_ptr<ScatterPart> module_part(const ScorePlan& plan);
std::unique_ptr<ScatterPart> spectrum_part(const ScorePlan& plan);
std::unique_ptr<ScatterPart> contact_part(const ScorePlan& plan);

}  // namespace lilytank
