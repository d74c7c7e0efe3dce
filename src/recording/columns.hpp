// The rows of one file as sightings.
#pragma once
#include "io/table.hpp"
#include "recording/sightings.hpp"

namespace lilytank {

/// Whether the format has one file a track; the track's number is in the file's name.
bool one_file_a_track(RecordingFormat format);

/// Adds the rows of a file, whose name is the last of out.files and whose format is known. Throws
/// InputError.
void read_columns(Table& table, const RecordingOptions& options, Sightings& out);

}  // namespace lilytank
