// Tables with one row a sighting, told apart by the names of their columns.
#pragma once
#include "recording/line_source.hpp"
#include "recording/sightings.hpp"

namespace lilytank {

/// Reads a file of one of these formats, its name being the last of out.files. Throws InputError.
void read_columns(LineSource& lines, const RecordingOptions& options, Sightings& out);

}  // namespace lilytank
