#include "tracks/latched.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "lilytank/math.hpp"
#include "tracks/sets.hpp"

namespace lilytank {
namespace {

constexpr int kMostFrames = 2000;  // the share of time in an assembly is then known to 0.02

struct Direction {
  double x, y;
};

// Outwards of a face.
Direction out_of(double theta, int face) {
  const double angle = theta + face * kPi / 2;
  return {std::cos(angle), std::sin(angle)};
}

// The module that a latched face holds: the nearest straight ahead that holds back; -1: none.
int held_by(const Trajectory& t, std::size_t frame, int module, int face) {
  constexpr double kAhead = 0.95, kBack = -0.9;  // cosines: places are rounded, latches may be new
  const auto at = [&](int m) { return frame + static_cast<std::size_t>(m); };
  const Direction out = out_of(t.theta[at(module)], face);
  int nearest = -1;
  double least = HUGE_VAL;
  for (int other = 0; other < t.modules; ++other) {
    if (other == module || t.markings[at(other)].latched == 0) continue;
    const double dx = t.x[at(other)] - t.x[at(module)], dy = t.y[at(other)] - t.y[at(module)];
    const double distance = std::hypot(dx, dy);
    if (!(distance < least) || dx * out.x + dy * out.y < kAhead * distance) continue;
    for (int back = 0; back < 4; ++back) {
      if ((t.markings[at(other)].latched >> back & 1) == 0) continue;
      const Direction in = out_of(t.theta[at(other)], back);
      if (in.x * out.x + in.y * out.y < kBack) nearest = other, least = distance;
    }
  }
  return nearest;
}

// Assemblies of a frame, as the first module of each module's.
std::vector<int> assemblies_in(const Trajectory& t, int f) {
  const std::size_t frame = static_cast<std::size_t>(f) * static_cast<std::size_t>(t.bodies);
  Sets sets(t.modules);
  for (int m = 0; m < t.modules; ++m) {
    const int latched = t.markings[frame + static_cast<std::size_t>(m)].latched;
    for (int face = 0; face < 4; ++face) {
      if ((latched >> face & 1) == 0) continue;
      const int other = held_by(t, frame, m, face);
      if (other >= 0) sets.join(m, other);
    }
  }
  std::vector<int> first;
  for (int m = 0; m < t.modules; ++m) first.push_back(sets.first(m));
  return first;
}

}  // namespace

std::vector<int> lasting_assemblies(const Trajectory& t) {
  std::vector<int> alone(static_cast<std::size_t>(t.modules), -1);
  if (t.markings.empty() || t.frames() == 0) return alone;
  const int stride = (t.frames() + kMostFrames - 1) / kMostFrames;
  std::map<std::pair<int, int>, int> together;  // frames of a pair
  int frames = 0;
  for (int f = 0; f < t.frames(); f += stride, ++frames) {
    std::map<int, std::vector<int>> members;
    const std::vector<int> first = assemblies_in(t, f);
    for (int m = 0; m < t.modules; ++m) members[first[static_cast<std::size_t>(m)]].push_back(m);
    for (const auto& [key, of] : members) {
      for (std::size_t i = 0; i < of.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) ++together[{of[j], of[i]}];
      }
    }
  }
  Sets lasting(t.modules);
  for (const auto& [pair, count] : together) {
    if (2 * count >= frames) lasting.join(pair.first, pair.second);
  }
  std::vector<int> out = alone;
  for (int m = 0; m < t.modules; ++m) {
    const int first = lasting.first(m);
    if (first != m) out[static_cast<std::size_t>(m)] = out[static_cast<std::size_t>(first)] = first;
  }
  return out;
}

}  // namespace lilytank
