#include <cmath>
#include <filesystem>
#include <optional>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/json.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/run.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

const std::string kAdvice = "run the scenario again with --force";

/// The first two columns of metrics.csv; the others depend on the number of modules.
void read_metrics(const std::string& file, StoredRun& run) {
  constexpr std::string_view first_columns = "time,copies,";
  const std::string text = read_whole(file);
  if (!text.starts_with(first_columns)) {
    throw InputError({file, 1, 1},
                     "the first line does not begin with \"" + std::string(first_columns) + "\"");
  }
  CsvReader reader(whole_lines(text), file, {text.substr(0, text.find('\n'))});
  while (reader.next()) {
    run.metrics_time.push_back(reader.number(0));
    run.metrics_copies.push_back(static_cast<int>(reader.whole(1, 0, 1 << 30)));
  }
}

/// How far the run came, where this program can read its checkpoint. Throws InputError if that is
/// of another scenario than the directory's: resolved.toml or a file that it names was changed.
std::optional<Checkpoint> checkpoint_of(const std::string& dir, const Scenario& scenario) {
  const std::string file = (fs::path(dir) / run_file::checkpoint).string();
  if (!exists(file)) return std::nullopt;
  const std::string bytes = read_whole(file);
  const auto identity = identity_in(bytes);
  if (!identity)
    return std::nullopt;  // of another version: the summary says whether the run is over
  if (*identity != scenario.identity) {
    std::string names = run_file::resolved;
    for (const Scenario::Attachment& attached : scenario.files) names += " or " + attached.name;
    throw InputError(
        {(fs::path(dir) / run_file::resolved).string()},
        names + " was changed since the run began; run the scenario again with --force");
  }
  return checkpoint_from(bytes, *identity, file);
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

void check_stored_run(const std::string& dir) {
  const std::string resolved = (fs::path(dir) / run_file::resolved).string();
  const auto checkpoint = checkpoint_of(dir, load_scenario({resolved}, {}));
  if (checkpoint) check_run_files(dir, "", *checkpoint, kAdvice);
}

StoredRun load_run(const std::string& dir) {
  const auto path = [&](const char* name) { return (fs::path(dir) / name).string(); };
  if (!exists(path(run_file::resolved))) {
    require_path(dir);
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
  const auto checkpoint = checkpoint_of(dir, run.scenario);
  if (checkpoint) check_run_files(dir, path(poses), *checkpoint, kAdvice);
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
