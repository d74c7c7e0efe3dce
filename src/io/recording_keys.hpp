// The keys of a [[recording]]: everything that RecordingOptions holds.
#pragma once
#include <string>
#include <vector>

#include "io/scenario_layers.hpp"
#include "lilytank/recording_io.hpp"

namespace lilytank {

/// Puts one value into the options. `prefix` names the table in messages ("recording"). Throws
/// InputError: unknown key, another kind, out of bounds.
void assign_recording_option(const Assignment& from, const std::string& prefix,
                             RecordingOptions& options);

}  // namespace lilytank
