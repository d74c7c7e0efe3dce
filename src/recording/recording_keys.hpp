// The keys of a [[recording]], and of a camera: everything that RecordingOptions and Camera hold.
#pragma once
#include <string>
#include <vector>

#include "io/scenario_layers.hpp"
#include "io/toml_key.hpp"
#include "lilytank/camera.hpp"
#include "lilytank/model.hpp"
#include "lilytank/recording_io.hpp"

namespace lilytank {

/// Puts one value into the options. `prefix` names the table in messages ("recording"). Throws
/// InputError: unknown key, another kind, out of bounds.
void assign_recording_option(const Assignment& from, const std::string& prefix,
                             RecordingOptions& options);
/// Puts a value of [experiment] other than its name into the options that all recordings share, or
/// into `further`: the file's recordings are added to those of earlier files. Throws InputError.
void assign_experiment_option(const Assignment& from, RecordingOptions& options, bool& further);
/// The tables of an experiment's file beside those of its scenario: [experiment], [[recording]].
TomlKeys experiment_tables();
/// The same for a camera; the prefix is "camera".
void assign_camera_option(const Assignment& from, Camera& camera);
/// Sets the tank's radius and the body's from the model's bodies of the options' kind.
void take_sizes(const Model& model, RecordingOptions& options);

/// The format of a word, which stands at `place`, of those that can be written. Throws InputError
/// with the nearest right one.
RecordingFormat format_to_write(const std::string& word, const SourcePlace& place);

}  // namespace lilytank
