#include "recording/experiment_file.hpp"

#include <algorithm>
#include <filesystem>

#include "io/scenario_values.hpp"
#include "recording/recording_keys.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

RecordingSource source_of(const CommandTable& table, const RecordingOptions& defaults) {
  RecordingSource out;
  out.options = defaults;
  out.place = table.place;
  for (const Assignment& field : table.fields) {
    if (field.path() != "file") {
      assign_recording_option(field, "recording", out.options);
      continue;
    }
    const std::string name = text_of(field, "recording.file");
    if (name.empty()) throw InputError(field.place, "recording.file is empty");
    out.file = (fs::path(field.directory) / name).lexically_normal().string();
    out.place = field.place;
  }
  if (out.file.empty()) {
    throw InputError(table.place, "recording.file is missing: the file of the tracks");
  }
  return out;
}

}  // namespace

void take_sizes(const Model& model, RecordingOptions& options) {
  options.tank_radius = model.tank.radius;
  options.body_radius = options.body == BodyKind::lily   ? model.module.side / 2
                        : options.body == BodyKind::ball ? model.ball.radius
                                                         : 0;
}

void read_experiment_tables(const std::vector<Layer>& layers, Experiment& experiment) {
  RecordingOptions defaults;
  const std::vector<CommandTable>* recordings = nullptr;
  for (const Layer& layer : layers) {
    for (const Assignment& field : layer.experiment) {
      if (field.path() == "name") {
        experiment.name = text_of(field, "experiment.name");
      } else {
        assign_recording_option(field, "experiment", defaults);
      }
    }
    if (layer.has_recordings) recordings = &layer.recordings;
  }
  if (recordings == nullptr) return;
  for (const CommandTable& table : *recordings) {
    experiment.sources.push_back(source_of(table, defaults));
    take_sizes(experiment.base.model, experiment.sources.back().options);
  }
}

}  // namespace lilytank
