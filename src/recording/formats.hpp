// From files to a checked recording, step by step.
#pragma once
#include <string>
#include <vector>

#include "io/table.hpp"
#include "recording/sightings.hpp"

namespace lilytank {

/// The files that `name` stands for, sorted: itself, or those in a directory (hidden ones left
/// out), or those that fit a pattern with '*' in its last part. Throws InputError if there are
/// none.
std::vector<std::string> files_of(const std::string& name);

/// The format of a file by its columns' names. Throws InputError if it is none that is known.
RecordingFormat detect_format(const Table& table);
/// Whether the format has one file a track; the track's number is in the file's name.
bool one_file_a_track(RecordingFormat format);

/// All rows of a recording's files, in the files' units. Throws InputError.
Sightings read_sightings(const std::vector<std::string>& files, const RecordingOptions& options);
/// The same for one open file, added to `out`; its format is found if out.format is automatic.
void read_sightings(LineSource& lines, const RecordingOptions& options, Sightings& out);
/// Adds the rows of a file, whose name is the last of out.files and whose format is known. Throws
/// InputError.
void read_columns(Table& table, const RecordingOptions& options, Sightings& out);
/// Adds the rows of a table of x1, y1, x2, y2, ...: a row a frame, the numbers are the bodies.
/// Throws InputError; also where they seem to be bounding boxes and the user did not name the
/// format.
void read_wide(Table& table, const RecordingOptions& options, Sightings& out);

/// Checks the rows and makes the tracks; options.format is known. The recording is left empty where
/// a finding refuses it. Throws InputError where nothing can be made of the rows at all.
CheckedRecording process(Sightings sightings, const RecordingOptions& options);

}  // namespace lilytank
