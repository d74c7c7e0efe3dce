#include <cmath>

#include "lilytank/metrics.hpp"
#include "text/number.hpp"
#include "tracks/latched.hpp"

namespace lilytank {
namespace {

// Frames on the even clock: all, or all but the last one, which may come early when a run ends.
int even_frames(const Trajectory& t) {
  if (t.frames() < 2) return t.frames();
  const int frames = t.frames();
  const double interval = t.time[1] - t.time[0];
  const auto even = [&](int f) {
    return std::fabs(t.time[f] - t.time[0] - f * interval) <= 1e-3 * interval;
  };
  int n = 0;
  while (n < frames && even(n)) ++n;
  if (n + 1 < frames) {
    throw InputError("stored frames are not at even times: frame " + std::to_string(n) + " is at " +
                     shortest(t.time[n]) + " s where the first two are " + shortest(interval) +
                     " s apart");
  }
  return n;
}

}  // namespace

Recording as_recording(const Trajectory& t, BodyKind body) {
  Recording recording;
  recording.body = body;
  recording.frames = even_frames(t);
  if (recording.frames > 0) recording.start = t.time[0];
  if (recording.frames > 1) {
    const int last = recording.frames - 1;
    recording.rate = last / (t.time[last] - t.time[0]);
  }
  const bool balls = body == BodyKind::ball;
  const int first = balls ? t.modules : 0, end = balls ? t.bodies : t.modules;
  std::vector<int> assembly;
  if (!balls) assembly = lasting_assemblies(t);
  for (int b = first; b < end; ++b) {
    Track track;
    track.id = b - first;
    if (!balls) track.assembly = assembly[static_cast<std::size_t>(b)];
    for (int f = 0; f < recording.frames; ++f) {
      const std::size_t at = static_cast<std::size_t>(f) * t.bodies + b;
      track.x.push_back(t.x[at]), track.y.push_back(t.y[at]);
      if (balls) continue;
      double theta = t.theta[at];
      if (f > 0) theta -= 2 * kPi * std::round((theta - track.theta.back()) / (2 * kPi));
      track.theta.push_back(theta);
    }
    recording.tracks.push_back(std::move(track));
  }
  return recording;
}

}  // namespace lilytank
