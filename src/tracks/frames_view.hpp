// A smoothed recording frame by frame: bodies with their poses, without frames that have no
// estimate.
#pragma once
#include <map>
#include <vector>

#include "lilytank/smoothing.hpp"

namespace lilytank {

/// Numbers bodies by the order in which their ids first appear among the tracks.
class BodyNumbers {
 public:
  explicit BodyNumbers(const SmoothRecording& recording) {
    for (const SmoothTrack& t : recording.tracks) number_.try_emplace(t.id, number_.size());
  }
  std::size_t of(const SmoothTrack& track) const { return number_.at(track.id); }
  std::size_t count() const { return number_.size(); }

 private:
  std::map<std::int64_t, std::size_t> number_;
};

/// Likewise numbers what bands resample: assemblies, and bodies of none.
class UnitNumbers {
 public:
  explicit UnitNumbers(const SmoothRecording& recording) {
    for (const SmoothTrack& t : recording.tracks) number_.try_emplace(t.unit(), number_.size());
  }
  std::size_t of(const SmoothTrack& track) const { return number_.at(track.unit()); }
  std::size_t count() const { return number_.size(); }

 private:
  std::map<std::int64_t, std::size_t> number_;
};

/// One body in one frame, and its unit of resampling.
struct SeenBody {
  std::size_t body = 0, unit = 0;
  double x = 0, y = 0, theta = 0;
};

/// Bodies seen in each frame, frame after frame in one array.
class FramesView {
 public:
  explicit FramesView(const SmoothRecording& recording);
  std::size_t bodies() const { return bodies_; }
  std::size_t units() const { return units_; }
  std::size_t frames() const { return begin_.size() - 1; }
  const SeenBody* begin(std::size_t frame) const { return seen_.data() + begin_[frame]; }
  const SeenBody* end(std::size_t frame) const { return seen_.data() + begin_[frame + 1]; }

 private:
  std::size_t bodies_ = 0, units_ = 0;
  std::vector<std::size_t> begin_;
  std::vector<SeenBody> seen_;
};

}  // namespace lilytank
