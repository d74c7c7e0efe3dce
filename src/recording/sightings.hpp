// What a file says, row by row, before it is checked and made into tracks.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lilytank/recording_io.hpp"

namespace lilytank {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kNoFrame = std::numeric_limits<std::int64_t>::min();

/// One body in one frame, in the file's units. Where a number is not given it is kUnknown.
struct Sighting {
  std::int64_t frame = kNoFrame;
  std::int64_t id = 0;
  double time = kUnknown;  ///< s
  double x = 0, y = 0;
  double theta = kUnknown;
  std::int32_t line = 0;
  std::int32_t file = 0;  ///< index into Sightings::files
};

/// How a format counts where the file itself does not say.
struct FormatUnits {
  double pixel = 0;  ///< m per unit of length; 0: the file is in pixels, the user must say
  bool y_down = false;
  bool degrees = false;
};

/// All of a recording's files.
struct Sightings {
  RecordingFormat format = RecordingFormat::tidy;
  FormatUnits units;
  std::vector<std::string> files;
  std::vector<Sighting> rows;  ///< in the files' order
  bool identities = true;      ///< false: ids mean nothing yet
  double rate = 0;             ///< frames per second if the files say so
  SourcePlace place(const Sighting& row) const {
    return {files[static_cast<std::size_t>(row.file)], row.line, 0};
  }
};

}  // namespace lilytank
