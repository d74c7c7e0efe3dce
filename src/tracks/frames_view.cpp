#include "tracks/frames_view.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank {
namespace {

// Whether a body was seen there, and the smoother estimated its pose: at a track's ends and beside
// holes a polynomial may have too few frames.
bool placed(const SmoothTrack& t, int i) {
  return t.seen[i] && !std::isnan(t.x[i]) && (t.theta.empty() || !std::isnan(t.theta[i]));
}

}  // namespace

FramesView::FramesView(const SmoothRecording& recording) {
  const BodyNumbers numbers(recording);
  const UnitNumbers units(recording);
  bodies_ = numbers.count(), units_ = units.count();
  int frames = 0;
  for (const SmoothTrack& t : recording.tracks) frames = std::max(frames, t.first + t.frames());
  begin_.assign(static_cast<std::size_t>(frames) + 1, 0);
  const auto for_each = [&](auto&& act) {
    for (const SmoothTrack& t : recording.tracks) {
      for (int i = 0; i < t.frames(); ++i) {
        if (placed(t, i)) act(t, i, static_cast<std::size_t>(t.first + i));
      }
    }
  };
  for_each([&](const SmoothTrack&, int, std::size_t f) { ++begin_[f + 1]; });
  for (std::size_t f = 1; f < begin_.size(); ++f) begin_[f] += begin_[f - 1];
  seen_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for_each([&](const SmoothTrack& t, int i, std::size_t f) {
    const double theta = t.theta.empty() ? 0 : t.theta[i];
    seen_[next[f]++] = {numbers.of(t), units.of(t), t.x[i], t.y[i], theta};
  });
}

}  // namespace lilytank
