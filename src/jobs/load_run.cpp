#include <cmath>
#include <filesystem>
#include <optional>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/run.hpp"
#include "text/json.hpp"
#include "text/number.hpp"

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

bool exists(const std::string& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

/// How far the run came, where this program can read its checkpoint.
std::optional<Checkpoint> checkpoint_of(const std::string& file, std::uint64_t identity) {
  if (!exists(file)) return std::nullopt;
  try {
    return checkpoint_from(read_whole(file), identity, file);
  } catch (const InputError&) {
    return std::nullopt;  // of another version: the summary tells whether the run is over
  }
}

/// Refuses a file that is shorter than its run's checkpoint says. A run that goes on may be ahead
/// of its checkpoint.
void check_length(const std::string& file, std::int64_t length, bool finished) {
  std::error_code problem;
  const auto size = static_cast<std::int64_t>(fs::file_size(file, problem));
  if (problem || size == length || (size > length && !finished)) return;
  throw InputError({file}, std::string(size < length ? "the file is cut: " : "") +
                               std::to_string(size) + " bytes, but the checkpoint of the " +
                               (finished ? "finished " : "") + "run says " +
                               std::to_string(length));
}

/// When a run was over (s), by its summary; nothing where there is none.
std::optional<double> end_of(const std::string& file) {
  if (!exists(file)) return std::nullopt;
  return json_number_of(read_whole(file), "time_s");
}

/// Refuses poses that end before their run did, by a frame or more.
void check_end(const StoredRun& run, const std::string& file, const std::optional<double>& end) {
  const Scenario& s = run.scenario;
  const double steps = std::max(1.0, std::ceil(1 / (s.output.rate * s.model.dt) - 1e-9));
  const double last = run.trajectory.time.back();
  if (!end || *end - last < (steps - 0.5) * s.model.dt) return;
  throw InputError({file}, "the file is cut: it ends at " + without_rounding(last) +
                               " s, and the run's summary says that it came to " +
                               without_rounding(*end) + " s");
}

}  // namespace

StoredRun load_run(const std::string& dir) {
  const auto path = [&](const char* name) { return (fs::path(dir) / name).string(); };
  if (!exists(path(run_file::resolved))) {
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
  // Before the poses are read, as a run that goes on only adds to them.
  const auto checkpoint = checkpoint_of(path(run_file::checkpoint), run.scenario.identity);
  if (checkpoint) {
    check_length(path(poses), checkpoint->lengths.trajectory, checkpoint->finished);
    check_length(path(run_file::metrics), checkpoint->lengths.metrics, checkpoint->finished);
  }
  if (!checkpoint && !exists(path(poses))) {
    throw InputError({path(poses)}, "there is no frame of the run yet");
  }
  run.trajectory = read_trajectory(path(poses));
  const int bodies = run.scenario.model.bodies();
  // Of a table that was cut in its first frame nobody knows how many rows that has.
  const bool cut = run.trajectory.frames() == 1 && run.trajectory.bodies < bodies;
  if (cut || run.trajectory.frames() == 0)
    throw InputError({path(poses)}, "there is no frame in it yet");
  if (run.trajectory.bodies != bodies) {
    throw InputError({path(poses)}, "poses of " + std::to_string(run.trajectory.bodies) +
                                        " bodies in a run of " + std::to_string(bodies));
  }
  if (!checkpoint) check_end(run, path(poses), end_of(path(run_file::summary_json)));
  read_metrics(path(run_file::metrics), run);
  return run;
}

}  // namespace lilytank
