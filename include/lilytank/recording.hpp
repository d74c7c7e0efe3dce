// Tracked motion of bodies in a tank, measured or simulated: the one type that every analysis
// reads.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

/// What was tracked. A point is a body of which only the position is known; lilies and balls have
/// the shapes of Model.
enum class BodyKind : std::uint8_t { lily, ball, point };

/// One body seen without a break of its identity, at frames [first, first + x.size()) of its
/// recording's clock. A frame in which it was not seen holds NaN in every array; the first and last
/// do not. Headings are continuous (unwrapped), and empty where none was tracked.
struct Track {
  /// As in the file; tracks that a check cut apart share it.
  std::int64_t id = 0;
  /// Frame of the first sighting, on the recording's clock.
  int first = 0;
  /// [frames] Position of the centre, m, tank centre at the origin, y up.
  std::vector<double> x, y;
  /// [frames] Heading, rad, counter-clockwise from +x.
  std::vector<double> theta;
  /// Frame of the last sighting.
  int last() const { return first + static_cast<int>(x.size()) - 1; }
};

/// Tracks on one even clock: frame f was taken at start + f / rate.
struct Recording {
  /// File or run that it came from, for messages and reports.
  std::string name;
  /// All tracks are of this kind.
  BodyKind body = BodyKind::lily;
  /// Frames per second.
  double rate = 30;
  /// Time of frame 0, s.
  double start = 0;
  /// Length of the clock: frames are numbered [0, frames).
  int frames = 0;
  /// Sorted by id, then first frame.
  std::vector<Track> tracks;
  /// False: the modules' latches were off.
  bool latches = true;
  /// Reserved for testing a fit: calibration and diagnosis do not fit it.
  bool held_out = false;
  /// Time of a frame, s.
  double time(int frame) const { return start + frame / rate; }
  /// Whether headings were tracked. All tracks of a recording have them or none.
  bool has_heading() const { return !tracks.empty() && !tracks.front().theta.empty(); }
};

}  // namespace lilytank
