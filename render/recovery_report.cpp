// Parameter recovery: intervals of synthetic experiments over their planted values.
#include <algorithm>
#include <cmath>

#include "lilytank/render.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

// A parameter's estimates with their intervals; on the diagonal they are true.
Plot recovery_plot(const std::vector<RecoveryRow>& rows, const std::string& parameter,
                   const std::vector<std::string>& objectives) {
  Plot plot;
  plot.width = 460, plot.height = 420;
  const std::string name = own_name(parameter);
  plot.x_label = name + ", planted", plot.y_label = name + ", estimated";
  double low = 0, high = 1;
  for (const std::string& objective : objectives) {
    Curve curve;
    curve.name = objective;
    curve.markers = curve.bars = true, curve.line = false;
    for (const RecoveryRow& r : rows) {
      if (r.parameter != parameter || r.objective != objective) continue;
      curve.x.push_back(r.truth), curve.y.push_back(r.estimate);
      curve.low.push_back(r.low), curve.high.push_back(r.high);
      low = r.bound_low, high = r.bound_high;
      plot.log_x = plot.log_y = r.logarithmic;
    }
    plot.curves.push_back(std::move(curve));
  }
  plot.curves.push_back({"estimate = truth", {low, high}, {low, high}, {}, {}});
  plot.x_low = plot.y_low = low, plot.x_high = plot.y_high = high;
  return plot;
}

}  // namespace

void draw_recovery(const std::vector<RecoveryRow>& rows, const ReportProvenance& provenance,
                   const std::string& dir, const FigureStyle& style) {
  std::vector<std::string> parameters, objectives;
  int experiments = 0;
  std::int64_t covered = 0;
  for (const RecoveryRow& r : rows) {
    const auto add = [](std::vector<std::string>& to, const std::string& word) {
      if (std::find(to.begin(), to.end(), word) == to.end()) to.push_back(word);
    };
    add(parameters, r.parameter), add(objectives, r.objective);
    experiments = std::max(experiments, r.experiment), covered += r.covered() ? 1 : 0;
  }
  if (rows.empty()) return;
  Figure figure{"recovery",
                "Estimates of synthetic experiments with their 95 % intervals over the planted "
                "values. Axes: the bounds of the prior."};
  for (const std::string& parameter : parameters) {
    figure.page.plots.push_back(recovery_plot(rows, parameter, objectives));
  }
  figure.page.columns = 3;
  const auto n = static_cast<std::int64_t>(rows.size());
  figure.page.title = std::to_string(covered) + " of " + std::to_string(n) +
                      " intervals contain the planted value.";
  figure.n = counted(experiments, "synthetic experiment");
  figure.band = "intervals: 95 %";
  draw_figures({figure}, provenance, dir, style);
}

}  // namespace lilytank
