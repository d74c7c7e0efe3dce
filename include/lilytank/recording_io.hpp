// Recordings from and to files: the layouts of common trackers, other tables by naming their
// columns, and the checks that every recording goes through. docs/recordings.md describes them.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lilytank/error.hpp"
#include "lilytank/recording.hpp"
#include "lilytank/table_layout.hpp"

namespace lilytank {

/// Layouts of trackers' files; docs/recordings.md has an example of each.
enum class RecordingFormat : std::uint8_t {
  automatic,            ///< found from the names of the columns
  tidy,                 ///< frame,time,id,x,y[,theta] in SI units: lilytank's own
  swistrack_tracks,     ///< one tab-separated file a track
  swistrack_particles,  ///< one row a particle and frame, without identities
  trackpy,              ///< y,x,...,frame,particle in pixels
  idtracker,            ///< frame,time,individual,x,y,probability
  idtracker_wide,       ///< time,x1,y1,x2,y2,...
  trex,                 ///< one file an individual, cm
  fasttrack,            ///< xBody, yBody, tBody, imageNumber, id in pixels
  boxes,                ///< one row a bounding box: frame, id, x1, y1, x2, y2 in pixels, y down
  table,                ///< any other, by RecordingOptions::columns
};
/// The word for a format in files and on the command line: "tidy", "swistrack-tracks", ...
std::string format_word(RecordingFormat format);

/// Names of a file's columns; an empty one is the format's own name.
struct ColumnNames {
  std::string frame, time, id, x, y, theta;
};

enum class YAxis : std::uint8_t { by_format, up, down };  ///< down: image coordinates
enum class AngleUnit : std::uint8_t { by_format, radians, degrees };

/// How a file's coordinates become metres from the tank's centre, y up. A circle of radius > 0
/// around the tank, in the file's units, gives both the scale and the origin.
struct Calibration {
  double pixel = 0;                 ///< metres per unit of the file; 0: as the format defines
  YAxis y_axis = YAxis::by_format;  ///< direction of the file's y axis
  /// Whether `origin_x` and `origin_y` are given; else the file's origin is the tank's centre.
  bool has_origin = false;
  double origin_x = 0, origin_y = 0;  ///< the tank's centre in the file's units
  double circle_radius = 0;           ///< radius of the tank in the file's units; 0: not given
  AngleUnit angles = AngleUnit::by_format;  ///< unit of the file's headings
};

/// A check of a recording. Each kind has a treatment, which can be chosen.
enum class Check : std::uint8_t {
  gap,        ///< a body was not seen in some frames
  duplicate,  ///< a body was seen twice in one frame
  spike,      ///< one sighting is far from those before and after it
  jump,       ///< a body goes on elsewhere from one frame to the next
  swap,       ///< two bodies go on in each other's places
  link,       ///< without identities, two bodies may both go on at one sighting
  speed,      ///< a body is faster than any can be
  outside,    ///< a body is outside the tank
  clock,      ///< times and frame numbers disagree, or times are uneven
  units,      ///< lengths or angles are in another unit than the options name
  heading,    ///< a heading leaps by more than a body can turn
  repeat,     ///< a moving body has exactly the pose of its last sighting, or is at exactly 0, 0
  columns,    ///< a column that is not used looks like one that matters
};
/// Number of kinds of checks.
constexpr int kChecks = 13;
/// "gap", "duplicate", ...: the word in files and reports.
std::string check_word(Check check);

/// What is done about a finding. A position is never moved, filled in, or given to another body.
enum class Treatment : std::uint8_t {
  keep,    ///< named, and left as it is
  mark,    ///< named, and the sighting counts as not seen: NaN in the track
  split,   ///< named, and the track is cut there in two
  refuse,  ///< named, and the recording is not used
};
/// "keep", "mark", "split" or "refuse".
std::string treatment_word(Treatment treatment);

/// Limits of the checks, and what is done beyond them.
struct CheckRules {
  /// The default treatment of each kind; docs/recordings.md lists them.
  CheckRules();
  std::array<Treatment, kChecks> treatments;  ///< indexed by Check
  double longest_gap = 0.2;                   ///< longest gap that does not cut the track, s
  double fastest = 2;                         ///< largest speed of a body, m/s
  double least_jump = 0.01;                   ///< shorter leaps are never called jumps or swaps, m
  double least_turn = 0.7;     ///< smaller turns between frames are never called leaps, rad
  double beyond_tank = 0.005;  ///< m that a centre may be nearer to the wall than the body allows
  double clock_error = 0.25;   ///< frames that a time may be off an even clock
  Treatment& operator[](Check check) { return treatments[static_cast<std::size_t>(check)]; }
  Treatment operator[](Check check) const { return treatments[static_cast<std::size_t>(check)]; }
};

/// Something that a check found.
struct Finding {
  Check check = Check::gap;               ///< which check found it
  Treatment treatment = Treatment::keep;  ///< what was done about it
  SourcePlace place;                      ///< file, and line where there is one
  std::int64_t frame = -1;                ///< frame as the file numbers it; -1: the whole file
  std::int64_t id = -1;                   ///< body as the file names it; -1: all bodies
  std::string what;                       ///< "not seen in 12 frames, 0.4 s"
  std::string name;                       ///< name of the body, where the file has words for ids
  /// "balls.csv:120: frame 4, id 3, gap: not seen in 12 frames, 0.4 s (track cut)"
  std::string text() const;
};
/// Texts of findings in their order: of each check in each file the first `most`, and a line with
/// the number of the others.
std::vector<std::string> finding_texts(const std::vector<Finding>& findings, int most);

/// About 3 GB of memory while a recording is read and checked.
constexpr std::int64_t kDefaultMostRows = 20'000'000;

/// How a recording is read and checked. The defaults suit a tidy file of Lilies.
struct RecordingOptions {
  RecordingFormat format = RecordingFormat::automatic;  ///< layout of the file
  std::string name;                       ///< name of the recording; empty: the file's name
  BodyKind body = BodyKind::lily;         ///< kind of the tracked bodies
  bool latches = true, held_out = false;  ///< as in Recording
  std::string events;                     ///< file of the modules' event log; empty: none
  ColumnNames columns;                    ///< names that differ from the format's
  TableLayout layout;
  Calibration calibration;
  double rate = 0;                  ///< frame numbers per second; 0: from the file's times
  std::optional<double> time_unit;  ///< s per unit of the file's times; not given: 1
  bool in_tank = true;              ///< false: places are not checked against a tank
  double tank_radius = 0.30;        ///< inner radius of the tank, m, for the check Check::outside
  double body_radius = 0;           ///< radius of the body's inscribed circle, m
  std::int64_t most_rows = kDefaultMostRows;  ///< sightings; more are refused
  CheckRules rules;                           ///< limits of the checks and what is done beyond them
};

/// Rows of a recording's files that are no sightings.
struct RowCounts {
  std::int64_t read = 0;      ///< rows in all, those below included
  std::int64_t not_seen = 0;  ///< rows without a position; of wide tables, cells without one
  std::int64_t without_identity = 0;  ///< rows of a body that was seen but not identified
};

/// A recording and all that was found in it.
struct CheckedRecording {
  Recording recording;  ///< the accepted tracks; none if the recording was refused
  RecordingFormat format = RecordingFormat::tidy;  ///< layout that was read: never automatic
  std::vector<std::string> files;                  ///< the files that were read, in this order
  std::int64_t rows = 0;                           ///< sightings in the files
  RowCounts counts;                ///< rows that were read, and those of them that are no sightings
  std::int64_t identities = 0;     ///< bodies that the files name; 0 where they name none
  std::int64_t comment_lines = 0;  ///< passed over below the names
  std::int64_t frame_step = 1;  ///< common step of the frame numbers, which the rate is divided by
  std::string times;            ///< how times were read, where that was a guess; or ""
  std::vector<Finding> findings;   ///< sorted by frame and id
  std::vector<std::string> names;  ///< names of the bodies, by id, where the file has words for ids
  std::vector<std::string> unused_columns;  ///< of the last file
  /// Whether a finding's treatment is Treatment::refuse.
  bool refused() const;
  /// Throws InputError with the first finding that refuses the recording, if there is one.
  void throw_if_refused() const;
};

/// Reads and checks one recording: a file (.gz or not), a directory with one file a track, or
/// such files by a pattern ("track*.csv"). Throws InputError with file and line: unreadable or
/// malformed.
CheckedRecording check_recording(const std::string& file, const RecordingOptions& options = {});
/// The same from several files that together are one recording.
CheckedRecording check_recording(const std::vector<std::string>& files,
                                 const RecordingOptions& options = {});
/// The recording alone. Throws InputError also where a check refuses it.
Recording read_recording(const std::string& file, const RecordingOptions& options = {});

/// Writes a recording in a format, compressed if the name ends in .gz: positions to 0.1 um,
/// headings to 1 urad, times to 0.1 ms. `file` is a directory for formats with one file a track.
/// Formats in pixels use the calibration. Throws InputError.
void write_recording(const Recording& recording, const std::string& file,
                     RecordingFormat format = RecordingFormat::tidy,
                     const Calibration& calibration = {});
/// What write_recording() writes: pairs of path and content. Throws InputError.
std::vector<std::pair<std::string, std::string>> recording_files(const Recording& recording,
                                                                 const std::string& file,
                                                                 RecordingFormat format,
                                                                 const Calibration& calibration);

}  // namespace lilytank
