#include "lilytank/experiment.hpp"

#include <cerrno>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_layers.hpp"
#include "io/scenario_values.hpp"
#include "io/standard_input.hpp"
#include "recording/event_log.hpp"
#include "recording/recording_keys.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

/// A message about a missing file should point to the place that names it.
void check_there(const std::string& file, const SourcePlace& place) {
  std::error_code ignored;
  if (file.find('*') != std::string::npos || fs::exists(file, ignored)) return;
  throw InputError(place, system_problem("cannot read", file, ENOENT));
}

RecordingSource source_of(const CommandTable& table, const RecordingOptions& defaults) {
  RecordingSource out;
  out.options = defaults;
  out.place = table.place;
  const auto file_of = [](const Assignment& field, const std::string& key) {
    const std::string name = text_of(field, key);
    if (name.empty()) throw InputError(field.place, key + " is empty");
    return (fs::path(field.directory) / name).lexically_normal().string();
  };
  for (const Assignment& field : table.fields) {
    if (field.path() == "file") {
      out.file = file_of(field, "recording.file"), out.place = field.place;
    } else if (field.path() == "events") {
      out.options.events = file_of(field, "recording.events");
      check_there(out.options.events, field.place);
    } else {
      assign_recording_option(field, "recording", out.options);
    }
  }
  if (out.file.empty()) {
    throw InputError(table.place, "recording.file is missing: the file of the tracks");
  }
  return out;
}

/// Name and sources of an experiment whose base is known; nothing is read. Keys of [experiment]
/// other than its name hold for all recordings that do not say otherwise.
void read_experiment_tables(const std::vector<Layer>& layers, Experiment& experiment) {
  RecordingOptions defaults;
  std::vector<CommandTable> recordings;
  for (const Layer& layer : layers) {
    bool further = false;
    for (const Assignment& field : layer.experiment) {
      if (field.path() == "name") {
        experiment.name = text_of(field, "experiment.name");
      } else {
        assign_experiment_option(field, defaults, further);
      }
    }
    if (!layer.has_recordings) continue;
    if (!further) recordings.clear();
    // First, as the last recordings are held out where none is marked: these stay the same.
    recordings.insert(recordings.begin(), layer.recordings.begin(), layer.recordings.end());
  }
  for (const CommandTable& table : recordings) {
    experiment.sources.push_back(source_of(table, defaults));
    take_sizes(experiment.base.model, experiment.sources.back().options);
  }
}

}  // namespace

void take_sizes(const Model& model, RecordingOptions& options) {
  options.tank_radius = model.tank.radius;
  options.body_radius = options.body == BodyKind::lily   ? model.module.side / 2
                        : options.body == BodyKind::ball ? model.ball.radius
                                                         : 0;
}

Experiment load_experiment(const std::vector<std::string>& files,
                           const std::vector<std::string>& sets,
                           const std::function<bool(const RecordingSource&)>& wanted) {
  const std::vector<Layer> layers = read_layers(files, sets);
  Experiment out;
  out.base = build_scenario(layers);
  read_experiment_tables(layers, out);
  if (out.sources.empty()) {
    throw InputError({files.empty() ? "" : files.back(), 0, 0},
                     "there is no [[recording]] in it: this is a scenario, not an experiment");
  }
  if (out.name.empty()) out.name = stem_of(files.back());
  for (const RecordingSource& source : out.sources) {
    if (wanted && !wanted(source)) continue;
    check_there(source.file, source.place);
    CheckedRecording checked = check_recording(source.file, source.options);
    checked.throw_if_refused();
    if (!source.options.events.empty()) {
      checked.recording.logged = true;
      checked.recording.events = read_event_log(source.options.events);
    }
    out.recordings.push_back(std::move(checked.recording));
    for (Finding& finding : checked.findings) out.findings.push_back(std::move(finding));
  }
  return out;
}

}  // namespace lilytank
