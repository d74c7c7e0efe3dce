// From the rows of a recording's files to a checked recording.
#pragma once
#include "recording/sightings.hpp"

namespace lilytank {

/// Checks the rows and makes the tracks; options.format is known. The recording is left empty where
/// a finding refuses it. Throws InputError where nothing can be made of the rows at all.
CheckedRecording process(Sightings sightings, const RecordingOptions& options);

}  // namespace lilytank
