#include "cli/stored_poses.hpp"

#include <algorithm>
#include <cmath>

#include "text/number.hpp"

namespace lilytank::cli {
namespace {

constexpr std::size_t kMostTimes = 2000;  // looked at, of a long film's

/// Adds the way of each body between the stored poses around a time.
void add_ways(const Trajectory& t, double time, std::vector<double>& ways) {
  const auto bodies = static_cast<std::size_t>(t.bodies);
  const auto after = static_cast<std::size_t>(
      std::upper_bound(t.time.begin(), t.time.end(), time + 1e-6) - t.time.begin());
  const bool between = after > 0 && after < t.time.size() && time - t.time[after - 1] > 1e-6;
  if (!between) {
    ways.insert(ways.end(), bodies, 0);
    return;
  }
  for (std::size_t b = 0; b < bodies; ++b) {
    const std::size_t to = after * bodies + b, from = to - bodies;
    ways.push_back(std::hypot(static_cast<double>(t.x[to]) - static_cast<double>(t.x[from]),
                              static_cast<double>(t.y[to]) - static_cast<double>(t.y[from])));
  }
}

}  // namespace

double stored_rate(const Trajectory& t) {
  return t.frames() > 1 ? (t.frames() - 1) / (t.time.back() - t.time.front()) : 0;
}

double way_between_poses(const Trajectory& trajectory, const std::vector<double>& times) {
  std::vector<double> ways;
  const std::size_t every = std::max<std::size_t>(1, times.size() / kMostTimes);
  for (std::size_t i = 0; i < times.size(); i += every) add_ways(trajectory, times[i], ways);
  if (ways.empty()) return 0;
  const auto at = ways.begin() + static_cast<std::ptrdiff_t>(9 * ways.size() / 10);
  std::nth_element(ways.begin(), at, ways.end());
  return *at;
}

std::string seldom_stored(const Trajectory& trajectory, const std::string& what,
                          const std::string& remedy) {
  const std::string rate = significant(stored_rate(trajectory), 3);
  return "poses were stored " + rate + (rate == "1" ? " time" : " times") +
         " a second; between them " + what + " (run with --set output.rate=" + remedy + ")\n";
}

std::string too_seldom_to_draw(const StoredRun& run, const std::vector<double>& times) {
  const Trajectory& t = run.trajectory;
  const Model& model = run.scenario.model;
  const double way = way_between_poses(t, times);
  if (way <= (t.modules > 0 ? 0.5 * model.module.side : model.ball.radius)) return "";
  return seldom_stored(t,
                       "one body in ten moves " + significant(100 * way, 3) +
                           " cm or more, drawn as a straight line",
                       stored_rate(t) < 19 ? "20" : "40");
}

}  // namespace lilytank::cli
