// What `lilytank recording` and its further words share.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "lilytank/recording_io.hpp"

namespace lilytank::cli {

/// Adds the options that say how recordings are read.
void add_reading_options(VerbOptions& options);

/// One recording that the user named, with what it was read as.
struct NamedRecording {
  std::string name;  ///< for messages: the file, or the first one and how many more
  std::vector<std::string> files;
  RecordingOptions options;
};
/// The recordings behind the arguments: those of experiment files (*.toml), and files; neighbouring
/// files of a format with one file a track are one recording. Throws InputError.
std::vector<NamedRecording> named_recordings(const VerbOptions& options,
                                             const std::vector<std::string>& arguments);
/// All files that reading these, as named by `arguments`, opens: none of them is to be written to.
std::vector<std::string> files_read(const std::vector<NamedRecording>& recordings,
                                    const std::vector<std::string>& arguments);

int recording_info(const Arguments& arguments);
int recording_check(const Arguments& arguments);
int recording_convert(const Arguments& arguments);

}  // namespace lilytank::cli
