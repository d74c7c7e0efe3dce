#include "cli/inputs.hpp"

#include <algorithm>
#include <cmath>

#include "io/scenario_layers.hpp"
#include "io/standard_input.hpp"
#include "lilytank/bodies.hpp"
#include "statistics/median.hpp"
#include "text/number.hpp"

namespace lilytank::cli {
namespace {

/// Recordings of a tank may be of points as well, but name no column as "x" and have no baseline.
bool has_keys_of_bodies(const Layer& layer) {
  const auto any = [](const std::vector<Assignment>& values, const auto& is) {
    return std::any_of(values.begin(), values.end(), is);
  };
  for (const CommandTable& recording : layer.recordings) {
    if (any(recording.fields, [](const Assignment& a) { return a.path() == "x"; })) return true;
  }
  return any(layer.values, [](const Assignment& a) { return a.keys.front() == "baseline"; });
}

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

/// How far (m) one body in ten moves at least between the stored poses before and after the given
/// times (s); a time at which poses were stored counts as no way.
double way_between_poses(const Trajectory& trajectory, const std::vector<double>& times) {
  std::vector<double> ways;
  const std::size_t every = std::max<std::size_t>(1, times.size() / kMostTimes);
  for (std::size_t i = 0; i < times.size(); i += every) add_ways(trajectory, times[i], ways);
  if (ways.empty()) return 0;
  const std::size_t rank = 9 * ways.size() / 10;
  return ranked(std::move(ways), rank);
}

}  // namespace

void refuse_point_bodies(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    if (!is_toml(file) || !is_body_experiment(file)) continue;
    const Layer layer = read_layers({file}, {}).front();
    if (!has_keys_of_bodies(layer)) continue;
    SourcePlace place{file, 0, 0};
    for (const Assignment& a : layer.experiment) {
      if (a.path() == "body") place = a.place;
    }
    throw InputError(place,
                     "this is an experiment of point bodies: for lilytank diagnose, one at a time");
  }
}

double stored_rate(const Trajectory& t) {
  return t.frames() > 1 ? (t.frames() - 1) / (t.time.back() - t.time.front()) : 0;
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
