// The rows of a file, before they are checked and made into tracks.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "io/time_text.hpp"
#include "lilytank/recording_io.hpp"

namespace lilytank {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kNoFrame = std::numeric_limits<std::int64_t>::min();

/// One body in one frame. Where a number is not given it is kUnknown.
struct Sighting {
  std::int64_t frame = kNoFrame;  ///< the file's number; once the clock is known, the recording's
  std::int64_t id = 0;
  double time = kUnknown;  ///< s
  double x = 0, y = 0;     ///< in the file's units, later m
  double theta = kUnknown;
  std::int32_t line = 0;
  std::int32_t file = 0;  ///< index into Sightings::files
  bool unseen = false;    ///< counts as not seen, by a check
  bool cut = false;       ///< the track is cut before it, by a check
  bool zero = false;      ///< at 0, 0 of the file: so some trackers write what they did not see
};

/// How a format counts, where the user does not say otherwise.
struct FormatUnits {
  double pixel = 1;        ///< m per unit of length; 0: pixels, of which the user must say the size
  bool y_down = false;     ///< image coordinates
  bool clockwise = false;  ///< headings
};

/// All of a recording's files.
struct Sightings {
  RecordingFormat format = RecordingFormat::tidy;
  FormatUnits units;
  std::vector<std::string> files;
  std::vector<Sighting> rows;      ///< in the files' order
  bool identities = true;          ///< false: ids mean nothing yet
  bool headings = false;           ///< there is a column of headings
  std::vector<std::string> names;  ///< of bodies, by id, if the file has words for ids
  std::unordered_map<std::string, std::int64_t> words;  ///< their ids
  TimeText times;                                       ///< which kind of times the files have
  std::vector<std::string> unused;                      ///< columns that were not read
  std::vector<std::string> hints;  ///< what columns that were not read may mean
  RowCounts counts;
  std::int64_t comment_lines = 0;  ///< passed over below the names
  std::int64_t most_rows = kDefaultMostRows;
  /// Adds a row of the last file. Throws InputError beyond most_rows.
  void add(const Sighting& row) {
    if (static_cast<std::int64_t>(rows.size()) >= most_rows) {
      throw InputError(place(row), "more than " + std::to_string(most_rows) +
                                       " sightings, of about 160 bytes of memory each: most_rows "
                                       "= N reads up to N of them");
    }
    rows.push_back(row);
  }
  SourcePlace place(const Sighting& row) const { return {files[row.file], row.line, 0}; }
};

}  // namespace lilytank
