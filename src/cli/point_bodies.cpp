#include "cli/point_bodies.hpp"

#include <algorithm>

#include "io/scenario_layers.hpp"
#include "lilytank/bodies.hpp"

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

}  // namespace

void refuse_point_bodies(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    if (!file.ends_with(".toml") || !is_body_experiment(file)) continue;
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

}  // namespace lilytank::cli
