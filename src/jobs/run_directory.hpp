// Output directory of one run: its files, ownership, and a lock.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jobs/checkpoint.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/scenario.hpp"

namespace lilytank {

/// Names of a run's files.
namespace run_file {
inline constexpr const char* resolved = "resolved.toml";
inline constexpr const char* trajectory_binary = "trajectory.bin";
inline constexpr const char* trajectory_csv = "trajectory.csv";
inline constexpr const char* events = "events.csv";
inline constexpr const char* metrics = "metrics.csv";
inline constexpr const char* rules = "rules.csv";
inline constexpr const char* species = "species.csv";
inline constexpr const char* bonds = "bonds.csv";
inline constexpr const char* summary_text = "summary.txt";
inline constexpr const char* summary_json = "summary.json";
inline constexpr const char* checkpoint = "checkpoint.bin";
inline constexpr const char* view = "view.html";  ///< by `lilytank view`
}  // namespace run_file

/// Paths of the files in `dir` that are a run's own, present or not: scenario, what it refers to,
/// results.
std::vector<std::string> files_of_run(const std::string& dir);

/// Compares the files in `dir`, and `poses` unless it is empty, with the checkpoint; a run that
/// goes on may be ahead of it. Throws InputError with `advice` and the file that was changed.
void check_run_files(const std::string& dir, const std::string& poses, const Checkpoint& checkpoint,
                     const std::string& advice);

/// Names of the pictures that `run --video` adds.
std::vector<std::string> pictures_of_run();

class RunDirectory {
 public:
  /// Looks into `dir`, changing nothing. Throws InputError if it holds another scenario's run,
  /// files that a run would overwrite, or a damaged run of this scenario, unless `force`.
  RunDirectory(std::string dir, const Scenario& scenario, bool force);

  /// Where this scenario's run stopped, if it was begun here.
  const std::optional<Checkpoint>& checkpoint() const { return checkpoint_; }
  /// Makes the directory, takes it for this process, and, where the run was not begun here, removes
  /// what another one left and writes the resolved scenario. Throws InputError.
  void open();

  /// Taken by open(); to be held until the last file of the run is written.
  std::shared_ptr<const DirectoryLock> lock() const { return lock_; }

  /// Compares the files of the run with its checkpoint. Throws InputError if one is missing or was
  /// changed.
  void check_files() const;
  std::string path(const std::string& name) const;
  /// "" where the scenario stores no poses.
  std::string trajectory_path() const;
  void save(const Checkpoint& checkpoint) const;
  /// Writes a file unless it holds just that already.
  void put(const std::string& name, const std::string& content) const;

 private:
  void look();
  bool same_run() const;
  std::string first_difference() const;
  std::vector<std::string> in_the_way() const;
  void remove_old() const;

  std::string dir_;
  const Scenario* scenario_;
  bool force_;
  bool ours_ = false;  ///< this scenario's run was begun here
  std::optional<Checkpoint> checkpoint_;
  std::shared_ptr<DirectoryLock> lock_ = std::make_shared<DirectoryLock>();
};

}  // namespace lilytank
