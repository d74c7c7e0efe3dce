// The layouts of trackers' files.
#pragma once
#include <string>
#include <vector>

#include "io/line_source.hpp"
#include "recording/columns.hpp"
#include "recording/sightings.hpp"

namespace lilytank {

/// The format of a file by its first line, which is given again by `lines`. Throws InputError if it
/// is none that is known.
RecordingFormat detect_format(LineSource& lines);
/// All rows of a recording's files, in the files' units. Throws InputError.
Sightings read_sightings(const std::vector<std::string>& files, const RecordingOptions& options);
/// The same for one open file, added to `out`; out.format is known.
void read_sightings(LineSource& lines, const RecordingOptions& options, Sightings& out);

}  // namespace lilytank
