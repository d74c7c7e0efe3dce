// The layouts of trackers' files.
#pragma once
#include <string>
#include <vector>

#include "io/table.hpp"
#include "recording/columns.hpp"
#include "recording/sightings.hpp"

namespace lilytank {

/// The format of a file by its columns' names. Throws InputError if it is none that is known.
RecordingFormat detect_format(const Table& table);
/// All rows of a recording's files, in the files' units. Throws InputError.
Sightings read_sightings(const std::vector<std::string>& files, const RecordingOptions& options);
/// The same for one open file, added to `out`; its format is found if out.format is automatic.
void read_sightings(LineSource& lines, const RecordingOptions& options, Sightings& out);

}  // namespace lilytank
