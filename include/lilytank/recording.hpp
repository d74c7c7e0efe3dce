// Tracked motion of bodies in a tank, measured or simulated: the one type that every analysis
// reads.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "lilytank/error.hpp"
#include "lilytank/event.hpp"

namespace lilytank {

/// What was tracked. A point is a body of which only the position is known; lilies and balls have
/// the shapes of Model.
enum class BodyKind : std::uint8_t { lily, ball, point };

/// One body seen without a break of its identity, at frames [first, first + x.size()) of its
/// recording's clock. A frame in which it was not seen holds NaN in every array; the first and last
/// do not. Headings are continuous (unwrapped), and empty where none was tracked.
struct Track {
  std::int64_t id = 0;  ///< as in the file; tracks that a check cut apart share it
  int first = 0;        ///< frame of the first sighting, on the recording's clock
  /// [frames] Position of the centre, m, tank centre at the origin, y up.
  std::vector<double> x, y;
  std::vector<double> theta;  ///< [frames] heading, rad, counter-clockwise from +x
  /// Id of the first body of the assembly that it is latched to for half of the recording or more;
  /// -1: none.
  std::int64_t assembly = -1;
  /// What bands resample: the assembly, or the body alone. One id for all tracks of it.
  std::int64_t unit() const { return assembly < 0 ? id : assembly; }
  /// Frame of the last sighting.
  int last() const { return first + static_cast<int>(x.size()) - 1; }
};

/// What a module reported by radio while it was recorded: an event of two modules (latch ..
/// update).
struct LoggedEvent {
  double time = 0;  ///< s, on the recording's clock
  EventKind kind = EventKind::latch;
  std::int64_t a = -1, b = -1;  ///< modules by the log's numbers, which need not be ids of tracks
};

/// Tracks on one even clock: frame f was taken at start + f / rate.
struct Recording {
  std::string name;                ///< file or run that it came from, for messages and reports
  BodyKind body = BodyKind::lily;  ///< all tracks are of this kind
  double rate = 30;                ///< frames per second
  double start = 0;                ///< time of frame 0, s
  int frames = 0;                  ///< length of the clock: frames are numbered [0, frames)
  std::vector<Track> tracks;       ///< sorted by id, then first frame
  bool latches = true;             ///< false: the modules' latches were off
  bool held_out = false;  ///< reserved for testing a fit: calibration and diagnosis do not fit it
  bool logged = false;    ///< the modules' events were logged
  std::vector<LoggedEvent> events;  ///< of the log, by time
  /// Time of a frame, s.
  double time(int frame) const { return start + frame / rate; }
  /// Whether headings were tracked. All tracks of a recording have them or none.
  bool has_heading() const { return !tracks.empty() && !tracks.front().theta.empty(); }
};

}  // namespace lilytank
