#include "diagnose/scan.hpp"

#include <algorithm>
#include <cmath>

#include "diagnose/scores.hpp"

namespace lilytank {
namespace {

constexpr double kSpacing = 0.16, kFarthest = 0.8;                    // of the tank's radius
constexpr double kWidths[] = {0.04, 0.06, 0.09};                      // m
constexpr double kShortest = 0.002, kLongest = 0.08, kLonger = 1.25;  // m, m, from one to the next
constexpr double kClear = 30;  // twice a log-likelihood: a rise that is no chance

}  // namespace

StreamPlace find_stream(const ScorePlan& plan, const std::vector<Recording>& recordings) {
  ScorePlan scan = plan;
  scan.effects.clear(), scan.shapes.clear();
  std::vector<StreamPlace> places;
  const double R = plan.model.tank.radius, step = kSpacing * R, row = step * std::sqrt(0.75);
  const int most = static_cast<int>(std::ceil(kFarthest * R / row));
  for (int j = -most; j <= most; ++j) {
    for (int i = -most; i <= most; ++i) {
      const double x = step * (i + (j % 2 == 0 ? 0 : 0.5)), y = row * j;
      if (std::hypot(x, y) > kFarthest * R) continue;
      for (const double width : kWidths) {
        places.push_back({x, y, width, 0, 0});
        scan.effects.push_back(stream_effect(plan.model, x, y, width));
      }
    }
  }
  const std::vector<ScoredAmplitude> told = scored_amplitudes(scan, recordings);
  StreamPlace best;
  double largest = -1;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ScoredAmplitude &x = told[2 * k], &y = told[2 * k + 1];
    if (!(x.gain + y.gain > largest)) continue;
    largest = x.gain + y.gain, best = places[k];
    best.speed_x = x.estimate, best.speed_y = y.estimate;
  }
  return best;
}

PairRange find_pair_range(const ScorePlan& plan, const std::vector<Recording>& recordings) {
  ScorePlan scan = plan;
  scan.effects.clear(), scan.shapes.clear();
  const auto attraction = std::find_if(plan.effects.begin(), plan.effects.end(),
                                       [](const Effect& e) { return e.name == "pair_attraction"; });
  std::vector<double> ranges;
  for (double range = kShortest; range < kLongest; range *= kLonger) {
    ranges.push_back(range);
    scan.effects.push_back(*attraction);
    scan.effects.back().shape = {{attraction->shape[0].first, range}};
  }
  const std::vector<ScoredAmplitude> told = scored_amplitudes(scan, recordings);
  const auto best = std::max_element(
      told.begin(), told.end(),
      [](const ScoredAmplitude& a, const ScoredAmplitude& b) { return a.gain < b.gain; });
  if (!(best->gain > kClear)) return {};
  return {ranges[static_cast<std::size_t>(best - told.begin())],
          best->estimate * attraction->sizes[0]};
}

}  // namespace lilytank
