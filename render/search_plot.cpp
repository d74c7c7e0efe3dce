#include <algorithm>
#include <cmath>

#include "lilytank/render.hpp"

namespace lilytank {

Plot search_plot(const std::vector<IterationRecord>& history, const std::string& title,
                 const std::string& y_label) {
  Plot plot;
  plot.title = title, plot.x_label = "evaluations", plot.y_label = y_label;
  Curve best{"best point so far"}, median{"median of an iteration's new points"};
  best.steps = true, median.markers = true;
  for (const IterationRecord& record : history) {
    const auto add = [&](Curve& curve, double value) {
      if (!std::isfinite(value)) return;
      curve.x.push_back(static_cast<double>(record.evaluations));
      curve.y.push_back(value);
    };
    add(best, record.best), add(median, record.median);
  }
  plot.curves = {std::move(median), std::move(best)};
  return plot;
}

}  // namespace lilytank
