// Tables of x1, y1, x2, y2, ...: a row a frame, the numbers are the bodies.
#pragma once
#include "io/table.hpp"
#include "recording/sightings.hpp"

namespace lilytank {

/// Whether the columns of a wide table stand beside one of identities or of scores, as in tables of
/// bounding boxes: then rows are detections, not frames.
bool has_detections(const std::vector<std::string>& names);
/// Adds the rows of a wide table. Throws InputError; also where they seem to be bounding boxes and
/// the user did not name the format.
void read_wide(Table& table, const RecordingOptions& options, Sightings& out);

}  // namespace lilytank
