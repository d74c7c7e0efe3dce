// Tanks of a page from stored runs, and from runs of a study, which are simulated again.
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/study_summary.hpp"
#include "lilytank/view.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

ViewTank tank_of_run(const std::string& dir) {
  ViewTank tank;
  tank.run = load_run(dir);
  const std::string file = (fs::path(dir) / run_file::events).string();
  tank.events = read_events(read_whole(file), file, tank.run.scenario.model.module.count);
  return tank;
}

/// The last part of a path: "a" of "out/a/".
std::string last_part(const std::string& dir) {
  const fs::path path = fs::path(dir).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string contents_of(const StoredRun& run) {
  const Model& model = run.scenario.model;
  std::string out;
  if (model.module.count > 0) out += counted(model.module.count, "module") + ", ";
  if (model.ball.count > 0) out += counted(model.ball.count, "ball") + ", ";
  return out + shortest(run.trajectory.time.back()) + " s, seed " +
         std::to_string(run.scenario.seed);
}

/// A directory for the files of runs, removed at the end.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string name = (fs::temp_directory_path() / "lilytank-view-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw InputError(system_problem("cannot make", name, errno));
    }
    path_ = name;
  }
  ~ScratchDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;

  std::string path(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

/// The scenario of a study's run with its seed, which stores poses.
Scenario storing_scenario(const Study& study, const RunRow& row, double rate,
                          const ScratchDirectory& scratch) {
  const Scenario source = study.scenario(row.setting);
  const std::string file = scratch.path("scenario.toml");
  for (const Scenario::Attachment& a : source.files) {
    write_atomically(scratch.path(a.name), a.content);
  }
  write_atomically(file, source.resolved);
  std::vector<std::string> sets{"run.seed=" + std::to_string(row.seed),
                                "output.trajectory=\"binary\""};
  if (rate > 0) sets.push_back("output.rate=" + shortest(rate));
  return load_scenario({file}, sets);
}

/// Simulates a run of a study again. Throws InputError if its result is not the row's.
ViewTank simulated_again(const Study& study, const RunRow& row, const ViewOptions& options) {
  const ScratchDirectory scratch;
  const Scenario scenario = storing_scenario(study, row, options.rate, scratch);
  RunOptions job;
  static_cast<JobControl&>(job) = options;
  job.out = scratch.path("run");
  const RunResult result = run(scenario, job);
  const auto same = [](double a, double b) { return std::fabs(a - b) < 1e-6; };  // printed times
  const std::vector<double>&was = row.completion, &is = result.completion_times;
  const bool equal = std::equal(was.begin(), was.end(), is.begin(), is.end(), same);
  if (!equal || result.status != row.status) {
    throw InputError("run " + row.id +
                     " of the study has another result in this version of the program: run the "
                     "study again");
  }
  ViewTank tank = tank_of_run(job.out);
  tank.name = study.plan().settings[static_cast<std::size_t>(row.setting)].label;
  if (tank.name.empty()) tank.name = study.plan().name;
  tank.note = "replicate " + std::to_string(row.replicate) + ", " + contents_of(tank.run);
  return tank;
}

const RunRow& row_of_id(const StoredStudy& stored, const std::string& id) {
  std::vector<std::string> ids;
  for (const RunRow& row : stored.table.rows) {
    if (row.id == id) return row;
    ids.push_back(row.id);
  }
  throw InputError("'" + id + "' is no run of the study; table.csv lists them" +
                   did_you_mean(id, ids));
}

std::vector<const RunRow*> chosen_rows(const StoredStudy& stored,
                                       const std::vector<std::string>& ids) {
  std::vector<const RunRow*> out;
  for (const std::string& id : ids) out.push_back(&row_of_id(stored, id));
  if (!ids.empty()) return out;
  int last = -1;
  for (const RunRow& row : stored.table.rows) {  // by setting and replicate
    if (row.setting == last || row.status != RunStatus::ok) continue;
    last = row.setting;
    out.push_back(&row);
    if (out.size() == kViewTanks) break;
  }
  return out;
}

}  // namespace

ViewPage view_runs(const std::vector<std::string>& dirs) {
  ViewPage page;
  for (const std::string& dir : dirs) {
    ViewTank& tank = page.tanks.emplace_back(tank_of_run(dir));
    tank.name = last_part(dir), tank.note = contents_of(tank.run);
    page.title += (page.title.empty() ? "" : ", ") + tank.name;
  }
  if (dirs.size() > 1) return page;
  ViewTank& only = page.tanks.front();
  page.subtitle = only.note;
  only.note.clear();
  return page;
}

ViewPage view_study(const std::string& dir, const Study& study, const std::vector<std::string>& ids,
                    const ViewOptions& options) {
  const StoredStudy stored = load_study(dir);
  if (stored.plan.identity() != study.plan().identity()) {
    throw InputError("'" + dir + "' holds the results of another study than " + study.plan().name);
  }
  ViewPage page;
  page.title = "Study " + stored.plan.name;
  const std::vector<const RunRow*> rows = chosen_rows(stored, ids);
  if (rows.empty()) throw InputError("'" + dir + "' holds no finished run yet");
  const StudySummary summary = summarise(stored.table);
  std::vector<int> shown;
  for (const RunRow* row : rows) {
    page.tanks.push_back(simulated_again(study, *row, options));
    if (std::find(shown.begin(), shown.end(), row->setting) != shown.end()) continue;
    shown.push_back(row->setting);
    const SettingSummary& setting = summary.settings[static_cast<std::size_t>(row->setting)];
    page.yields.push_back(
        {"mean of " + counted(setting.runs, "run") + ", " + page.tanks.back().name, setting.yield});
  }
  page.subtitle = counted(static_cast<int>(rows.size()), "run") + " of " +
                  std::to_string(stored.table.rows.size());
  return page;
}

}  // namespace lilytank
