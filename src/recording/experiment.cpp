#include "lilytank/experiment.hpp"

#include <filesystem>

#include "io/experiment_file.hpp"
#include "io/scenario_build.hpp"

namespace lilytank {

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
  if (out.name.empty()) out.name = std::filesystem::path(files.back()).stem().string();
  for (const RecordingSource& source : out.sources) {
    if (wanted && !wanted(source)) continue;
    CheckedRecording checked = check_recording(source.file, source.options);
    checked.throw_if_refused();
    out.recordings.push_back(std::move(checked.recording));
    for (Finding& finding : checked.findings) out.findings.push_back(std::move(finding));
  }
  return out;
}

}  // namespace lilytank
