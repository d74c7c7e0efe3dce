#include "yield.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lilytank/render.hpp"
#include "poses.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

// Keeps the first of equal values, and the last time.
void append(YieldCurve& curve, double time, int copies, bool last) {
  if (curve.copies.empty() || curve.copies.back() != copies || last) {
    curve.time.push_back(time);
    curve.copies.push_back(copies);
  }
}

}  // namespace

int YieldCurve::at(double t) const {
  if (time.empty()) return 0;
  const auto after = std::upper_bound(time.begin(), time.end(), t) - time.begin();
  return copies[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - 1))];
}

YieldCurve yield_of(const StoredRun& run) {
  YieldCurve curve;
  const Model& model = run.scenario.model;
  if (model.rulesets.empty() || model.rulesets[0].target.empty()) return curve;
  curve.target_size = static_cast<int>(model.rulesets[0].target.size());
  curve.possible = model.module.count / curve.target_size;
  if (!run.trajectory.markings.empty()) {
    const int frames = run.trajectory.frames();
    for (int f = 0; f < frames; ++f) {
      append(curve, run.trajectory.time[static_cast<std::size_t>(f)],
             copies_in_frame(run.trajectory, f, curve.target_size), f + 1 == frames);
    }
  } else {
    const std::size_t rows = std::min(run.metrics_time.size(), run.metrics_copies.size());
    for (std::size_t i = 0; i < rows; ++i) {
      append(curve, run.metrics_time[i], run.metrics_copies[i], i + 1 == rows);
    }
  }
  return curve;
}

std::vector<int> copy_ticks(int most) {
  constexpr int kMostSteps = 5;
  int step = 1;
  while (most % step != 0 || most / step > kMostSteps) ++step;
  // Of a prime nothing is left but its ends: round steps then, and the last one shorter or longer.
  if (step == most && most > kMostSteps) step = (most + 3) / 4;
  std::vector<int> ticks{0};
  for (int k = step; k < most && 2 * (most - k) > step; k += step) ticks.push_back(k);
  if (most > 0) ticks.push_back(most);
  return ticks;
}

TimeUnit unit_for(double length) {
  if (length > 3 * 3600) return {3600, "h"};
  if (length > 180) return {60, "min"};
  return {1, "s"};
}

std::string clock_text(double time) {
  // Half a millisecond keeps times such as 0.1 * 30 from showing the second before.
  const auto whole = static_cast<long long>(std::floor(std::max(0.0, time) + 5e-4));
  char text[40];
  std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
  return text;
}

Plot yield_plot(const StoredRun& run) {
  Plot plot;
  const YieldCurve found = yield_of(run);
  Curve curve;
  curve.name = "completed copies";
  curve.steps = true;
  std::vector<double> time = run.metrics_time;
  std::vector<double> copies(run.metrics_copies.begin(), run.metrics_copies.end());
  if (time.empty()) {
    time = found.time;
    copies.assign(found.copies.begin(), found.copies.end());
  }
  const double end = std::max(time.empty() ? 0.0 : time.back(), run.scenario.duration);
  const TimeUnit unit = unit_for(end);
  for (double& t : time) t /= unit.seconds;
  curve.x = std::move(time);
  curve.y = std::move(copies);
  plot.x_label = "time (" + unit.name + ")";
  plot.y_label = "copies of the target";
  if (found.possible > 0 && !curve.y.empty()) {
    plot.title = "After " + significant(curve.x.back(), 3) + " " + unit.name + ", " +
                 significant(curve.y.back(), 4) + " of " + std::to_string(found.possible) +
                 (found.possible == 1 ? " copy is complete." : " copies are complete.");
  }
  int most = 1;
  for (const double c : curve.y) most = std::max(most, static_cast<int>(c));
  if (found.possible > 0) {
    most = std::max(most, found.possible);
    const double p = found.possible;
    plot.curves.push_back({"possible", {0, end / unit.seconds}, {p, p}, {}, {}, false, false});
  }
  plot.curves.insert(plot.curves.begin(), std::move(curve));
  plot.y_low = -0.04 * most;
  plot.y_high = 1.08 * most;
  return plot;
}

}  // namespace lilytank
