#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/run.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

/// The first two columns of metrics.csv; the others depend on the number of modules.
void read_metrics(const std::string& file, StoredRun& run) {
  const std::string text = read_whole(file);
  CsvReader reader(text, file, {text.substr(0, text.find('\n'))}, true);
  while (reader.next()) {
    run.metrics_time.push_back(reader.number(0));
    run.metrics_copies.push_back(static_cast<int>(reader.whole(1, 0, 1 << 30)));
  }
}

}  // namespace

StoredRun load_run(const std::string& dir) {
  const auto path = [&](const char* name) { return (fs::path(dir) / name).string(); };
  std::error_code ignored;
  if (!fs::exists(path(run_file::resolved), ignored)) {
    throw InputError("'" + dir + "' is not the directory of a run: it has no " +
                     std::string(run_file::resolved));
  }
  StoredRun run;
  run.scenario = load_scenario({path(run_file::resolved)}, {});
  const char* poses = run.scenario.output.trajectory == TrajectoryFormat::csv
                          ? run_file::trajectory_csv
                          : run_file::trajectory_binary;
  if (run.scenario.output.trajectory == TrajectoryFormat::none) {
    throw InputError("the run in '" + dir + "' stored no poses: output.trajectory was \"none\"");
  }
  run.trajectory = read_trajectory(path(poses));
  if (run.trajectory.frames() == 0) throw InputError({path(poses)}, "there is no frame in it yet");
  read_metrics(path(run_file::metrics), run);
  return run;
}

}  // namespace lilytank
