// Tracks with known statistics, for tests of analysis.
#pragma once
#include <cmath>
#include <limits>

#include "lilytank/random.hpp"
#include "lilytank/recording.hpp"

namespace lilytank::test {

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

/// A standard normal number; two per (step, body) with `index` 0 and 1, more with higher ones.
inline double normal(std::uint64_t seed, int step, int body, std::uint32_t index = 0) {
  return normal_pair(
      {seed, Stream::gust, step, static_cast<std::uint32_t>(body), index / 2})[index % 2];
}

/// `bodies` tracks of `frames` frames; place(body, frame) gives {x, y}.
template <class Place>
Recording recording_of(int bodies, int frames, double rate, const Place& place) {
  Recording r;
  r.rate = rate, r.frames = frames, r.body = BodyKind::ball;
  for (int b = 0; b < bodies; ++b) {
    Track t;
    t.id = b;
    for (int f = 0; f < frames; ++f) {
      const auto p = place(b, f);
      t.x.push_back(p[0]), t.y.push_back(p[1]);
    }
    r.tracks.push_back(std::move(t));
  }
  return r;
}

/// Random walks: each step moves each axis by a normal number of deviation `step`.
inline Recording random_walks(std::uint64_t seed, int bodies, int frames, double rate,
                              double step) {
  std::array<double, 2> at{};
  return recording_of(bodies, frames, rate, [&](int b, int f) {
    if (f == 0) at = {0, 0};
    const auto now = at;
    at[0] += step * normal(seed, f, b, 0), at[1] += step * normal(seed, f, b, 1);
    return now;
  });
}

/// Takes sightings away at random, but never a track's ends.
inline void make_gaps(Recording& r, std::uint64_t seed, double share) {
  for (Track& t : r.tracks) {
    for (std::size_t f = 1; f + 1 < t.x.size(); ++f) {
      const Draw draw{seed, Stream::start_pose, static_cast<std::int64_t>(f),
                      static_cast<std::uint32_t>(t.id)};
      if (uniform(draw) >= share) continue;
      t.x[f] = t.y[f] = kUnseen;
      if (!t.theta.empty()) t.theta[f] = kUnseen;
    }
  }
}

}  // namespace lilytank::test
