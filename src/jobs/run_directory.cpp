#include "jobs/run_directory.hpp"

#include <filesystem>
#include <sstream>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/file_digest.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

bool holds(const std::string& file, const std::string& content) {
  return exists(file) && read_whole(file) == content;
}

constexpr const char* kResults[] = {run_file::trajectory_binary,
                                    run_file::trajectory_csv,
                                    run_file::events,
                                    run_file::metrics,
                                    run_file::rules,
                                    run_file::species,
                                    run_file::bonds,
                                    run_file::summary_text,
                                    run_file::summary_json,
                                    run_file::checkpoint};

/// Names in a run's directory that load_scenario gives to attachments.
std::vector<std::string> attached_names(const std::string& dir) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(dir, ignored)) {
    std::string name = entry.path().filename().string();
    const bool rules = name.starts_with("ruleset") && name.ends_with(".rules");
    if (rules || name == "flow.csv" || name == "poses.csv") names.push_back(std::move(name));
  }
  return names;
}

/// What differs in a line of two resolved scenarios: the values, or, where these are equal, all
/// that follows them.
std::string difference(const std::string& there, const std::string& here, int line) {
  const auto value = [](const std::string& text) { return text.substr(0, text.find("  #")); };
  if (value(there) != value(here)) {
    return "there '" + value(there) + "', here '" + value(here) + "'";
  }
  return std::string(run_file::resolved) + ":" + std::to_string(line) +
         " was changed or is damaged: there '" + there + "', here '" + here + "'";
}

}  // namespace

std::vector<std::string> files_of_run(const std::string& dir) {
  std::vector<std::string> names = attached_names(dir);
  names.insert(names.end(), std::begin(kResults), std::end(kResults));
  names.push_back(run_file::resolved);
  for (std::string& name : names) name = (fs::path(dir) / name).string();
  return names;
}

void check_run_files(const std::string& dir, const std::string& poses, const Checkpoint& checkpoint,
                     const std::string& advice) {
  const RunFileDigests& files = checkpoint.files;
  const auto check = [&](const std::string& file, const FileDigest& digest) {
    check_digest(file, digest, checkpoint.finished, advice);
  };
  if (!poses.empty()) check(poses, files.trajectory);
  check((fs::path(dir) / run_file::events).string(), files.events);
  check((fs::path(dir) / run_file::metrics).string(), files.metrics);
}

std::vector<std::string> pictures_of_run() {
  return with_figures({"video.mp4", "report.html"}, {"yield", "frame"});
}

RunDirectory::RunDirectory(std::string dir, const Scenario& scenario, bool force)
    : dir_(std::move(dir)), scenario_(&scenario), force_(force) {
  look();
}

void RunDirectory::look() {
  std::error_code ignored;
  if (exists(dir_) && !fs::is_directory(dir_, ignored)) {
    throw InputError("'" + dir_ + "' is a file; the results need a directory");
  }
  ours_ = same_run();
  if (ours_ && exists(path(run_file::checkpoint))) {
    const std::string file = path(run_file::checkpoint);
    try {
      checkpoint_ = checkpoint_from(read_whole(file), scenario_->identity, file);
      if (force_) check_files();
    } catch (const InputError&) {
      if (!force_) throw;
      ours_ = false, checkpoint_.reset();  // damaged: the run begins again
    }
  }
  if (ours_ || force_) return;
  if (exists(path(run_file::resolved))) {
    throw InputError("'" + dir_ + "' holds another run (" + first_difference() + ")" +
                     kChooseAnother);
  }
  refuse_foreign(dir_, in_the_way(), "run");
}

std::string RunDirectory::path(const std::string& name) const {
  return (fs::path(dir_) / name).string();
}

std::string RunDirectory::trajectory_path() const {
  switch (scenario_->output.trajectory) {
    case TrajectoryFormat::binary:
      return path(run_file::trajectory_binary);
    case TrajectoryFormat::csv:
      return path(run_file::trajectory_csv);
    case TrajectoryFormat::none:
      break;
  }
  return "";
}

bool RunDirectory::same_run() const {
  if (!holds(path(run_file::resolved), scenario_->resolved)) return false;
  for (const Scenario::Attachment& file : scenario_->files) {
    if (!holds(path(file.name), file.content)) return false;
  }
  return true;
}

// The resolved texts differ line by line, or an attached file does.
std::string RunDirectory::first_difference() const {
  std::istringstream theirs(read_whole(path(run_file::resolved))), ours(scenario_->resolved);
  std::string there, here;
  for (int line = 1;; ++line) {
    const bool more_there = static_cast<bool>(std::getline(theirs, there));
    const bool more_here = static_cast<bool>(std::getline(ours, here));
    if (!more_there && !more_here) return "with another ruleset, flow or start file";
    if (!more_there || !more_here || there != here) return difference(there, here, line);
  }
}

// Without resolved.toml: attachments may lie there from a run killed while it began.
std::vector<std::string> RunDirectory::in_the_way() const {
  std::vector<std::string> files = existing_in(dir_, {std::begin(kResults), std::end(kResults)});
  for (std::string& picture : existing_in(dir_, pictures_of_run())) {
    files.push_back(std::move(picture));
  }
  for (const Scenario::Attachment& file : scenario_->files) {
    const bool other = exists(path(file.name)) && !holds(path(file.name), file.content);
    if (other) files.push_back(path(file.name));
  }
  return files;
}

void RunDirectory::remove_old() const {
  std::error_code ignored;
  // Only beside a resolved.toml are these names sure to be a run's copies and not a user's files.
  const bool run = fs::remove(path(run_file::resolved), ignored);
  for (const char* name : kResults) fs::remove(path(name), ignored);
  fs::remove(path(run_file::view), ignored);
  for (const std::string& name : pictures_of_run()) fs::remove(path(name), ignored);
  for (const std::string& name : run ? attached_names(dir_) : std::vector<std::string>{}) {
    fs::remove(path(name), ignored);
  }
}

void RunDirectory::open() {
  lock_->take(dir_);
  // Another process may have worked here between the look and the lock.
  const auto progress = [&] {
    return std::pair(ours_, checkpoint_ ? checkpoint_->state.step : std::int64_t{-1});
  };
  const auto seen = progress();
  look();
  if (progress() != seen) {
    throw InputError("another process has just been at work in '" + dir_ + "'; run again");
  }
  if (ours_) return;
  if (force_) remove_old();
  // The resolved scenario comes last: it says that the run was begun.
  for (const Scenario::Attachment& file : scenario_->files) {
    write_atomically(path(file.name), file.content);
  }
  write_atomically(path(run_file::resolved), scenario_->resolved);
}

void RunDirectory::check_files() const {
  check_run_files(dir_, trajectory_path(), *checkpoint_, "--force runs the run again");
}

void RunDirectory::save(const Checkpoint& checkpoint) const {
  write_atomically(path(run_file::checkpoint), to_bytes(checkpoint, scenario_->identity));
}

void RunDirectory::put(const std::string& name, const std::string& content) const {
  if (!holds(path(name), content)) write_atomically(path(name), content);
}

}  // namespace lilytank
