// From the rows of a file to tracks, and the checks on the way.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "recording/report.hpp"
#include "recording/sightings.hpp"

namespace lilytank {

/// Of a vector; positions are far from where std::hypot would be worth its time.
inline double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

/// Turns positions into metres from the tank's centre, y up, and headings into counter-clockwise
/// radians, and looks for degrees. Throws InputError if the size of a pixel is not known.
void to_metres(Sightings& sightings, const RecordingOptions& options, Report& report);

/// Looks for sightings that repeat the pose before them exactly although the body moves: poses that
/// the tracker held, frames that were written twice, and 0, 0 for what was not seen.
void check_repeats(Sightings& sightings, Report& report);

/// Looks for lengths in another unit than the options name, in a tank.
void check_lengths(const Sightings& sightings, const RecordingOptions& options, Report& report);

/// Frames at even times.
struct FrameClock {
  double rate = 0;         ///< 1/s
  double start = 0;        ///< s, of frame `first`
  std::int64_t first = 0;  ///< the file's number of the recording's frame 0
  std::int64_t step = 1;   ///< of the file's numbers, from one frame to the next
  int frames = 0;
  /// The file's number of a frame.
  std::int64_t number(std::int64_t frame) const { return first + step * frame; }
};
/// Finds rate and start, counts the frames of the rows from 0 on this clock, and looks for times
/// that are not where they should be. Where frames have no numbers, times count them. Rows that are
/// unseen in frames between those of the clock are removed. Throws InputError if the rate cannot be
/// known.
FrameClock find_clock(Sightings& sightings, const RecordingOptions& options, Report& report);

/// Gives ids to rows without identities: a row goes on with the track whose prediction is nearest;
/// where two tracks compete, both end.
void link(Sightings& sightings, const FrameClock& clock, const RecordingOptions& options,
          Report& report);

/// One body in one frame.
struct Point {
  int frame = 0;  ///< of the recording
  std::int32_t row = 0;
  double x = 0, y = 0, theta = 0;  ///< m, rad
  bool unseen = false, cut = false;
};

/// All rows of an id, by frame, each frame once.
struct Path {
  std::int64_t id = 0;
  std::vector<Point> points;
};

/// Rows by id and frame; looks for duplicates.
std::vector<Path> make_paths(const Sightings& sightings, const FrameClock& clock, Report& report);

/// What the checks of paths share.
struct CheckContext {
  const Sightings& sightings;
  const FrameClock& clock;
  const RecordingOptions& options;
  Report& report;
  SourcePlace place(const Point& point) const { return sightings.place(sightings.rows[point.row]); }
  std::int64_t frame(const Point& point) const { return clock.number(point.frame); }
};

void check_gaps(const std::vector<Path>& paths, const CheckContext& context);
void check_outside(std::vector<Path>& paths, const CheckContext& context);
/// Spikes, jumps, swaps, speeds and headings.
void check_motion(std::vector<Path>& paths, const CheckContext& context);

/// Paths cut where checks say so; headings continued over whole turns.
std::vector<Track> make_tracks(const std::vector<Path>& paths, const CheckContext& context);

}  // namespace lilytank
