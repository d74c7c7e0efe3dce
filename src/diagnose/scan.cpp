#include "diagnose/scan.hpp"

#include <algorithm>
#include <cmath>

#include "diagnose/scores.hpp"
#include "lilytank/study.hpp"

namespace lilytank {
namespace {

constexpr double kSpacing = 0.16, kFarthest = 0.8;  // of the tank's radius
constexpr double kWidths[] = {0.04, 0.06, 0.09};    // m
// What has a range, from where to where it is tried, m, and a factor from one to the next.
struct Ranged {
  const char* effect;
  double shortest, longest;
};
constexpr Ranged kRanged[] = {
    {"pair_attraction", 0.002, 0.08}, {"wall_force", 0.002, 0.05}, {"wall_layer", 0.005, 0.08}};
constexpr double kLonger = 1.25;
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

std::map<std::string, ScannedValue> find_values(const ScorePlan& plan,
                                                const std::vector<Recording>& recordings) {
  ScorePlan scan = plan;
  scan.effects.clear(), scan.shapes.clear();
  for (const Ranged& of : kRanged) {
    const auto effect = std::find_if(plan.effects.begin(), plan.effects.end(),
                                     [&](const Effect& e) { return e.name == of.effect; });
    for (double range = of.shortest; range < of.longest; range *= kLonger) {
      scan.effects.push_back(*effect);
      scan.effects.back().shape = {{effect->shape[0].first, range}};
    }
  }
  const std::vector<ScoredAmplitude> told = scored_amplitudes(scan, recordings);
  std::map<std::string, ScannedValue> out;
  std::map<std::string, double> most;
  for (std::size_t k = 0; k < told.size(); ++k) {
    const Effect& effect = scan.effects[k];
    const bool possible = effect.two_sided || effect.name == "pair_attraction";
    double& best = most.emplace(effect.name, kClear).first->second;
    if (!(told[k].gain > best) || (!possible && told[k].estimate < 0)) continue;
    best = told[k].gain, out[effect.name] = {effect.shape[0].second, told[k].estimate};
  }
  return out;
}

Scans scans_of(const ScorePlan& plan, const std::vector<Recording>& recordings, int threads) {
  Scans out;
  for_each_world(2, threads, [&](int i) {
    if (i == 0) out.stream = find_stream(plan, recordings);
    if (i == 1) out.values = find_values(plan, recordings);
  });
  return out;
}

}  // namespace lilytank
