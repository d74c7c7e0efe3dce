#include <algorithm>
#include <cmath>

#include "lilytank/render.hpp"

namespace lilytank {

Plot search_plot(const std::vector<IterationRecord>& history, bool selected,
                 const std::string& title, const std::string& y_label) {
  Plot plot;
  plot.title = title, plot.x_label = "evaluations", plot.y_label = y_label;
  Curve best{"best point so far"}, median{"median of an iteration's new points"};
  Curve last{"final selection"};
  best.steps = true, median.markers = true;
  last.markers = true, last.line = false;
  const auto add = [](Curve& curve, const IterationRecord& record, double value) {
    if (!std::isfinite(value)) return;
    curve.x.push_back(static_cast<double>(record.evaluations));
    curve.y.push_back(value);
  };
  for (const IterationRecord& record : history) {
    // A selection has no new points, and what it counts is not what the best so far were chosen by.
    if (selected && &record == &history.back()) {
      add(last, record, record.best);
      if (!best.y.empty()) add(best, record, best.y.back());
      continue;
    }
    add(best, record, record.best), add(median, record, record.median);
  }
  // Points at the end of the search keep off the frame.
  if (!history.empty()) plot.x_high = 1.03 * static_cast<double>(history.back().evaluations);
  plot.curves = {std::move(median), std::move(best)};
  if (!last.x.empty()) plot.curves.push_back(std::move(last));
  return plot;
}

}  // namespace lilytank
