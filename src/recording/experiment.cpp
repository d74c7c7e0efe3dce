#include "lilytank/experiment.hpp"

#include <cerrno>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_build.hpp"
#include "recording/experiment_file.hpp"

namespace lilytank {
namespace {

/// A message about a missing file should point to who asked for it.
void check_there(const RecordingSource& source) {
  std::error_code ignored;
  const bool pattern = source.file.find('*') != std::string::npos;
  if (pattern || std::filesystem::exists(source.file, ignored)) return;
  throw InputError(source.place, system_problem("cannot read", source.file, ENOENT));
}

}  // namespace

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
    check_there(source);
    CheckedRecording checked = check_recording(source.file, source.options);
    checked.throw_if_refused();
    out.recordings.push_back(std::move(checked.recording));
    for (Finding& finding : checked.findings) out.findings.push_back(std::move(finding));
  }
  return out;
}

}  // namespace lilytank
