#include "optimize/search_directory.hpp"

#include <filesystem>
#include <functional>

#include "io/atomic_file.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/search_run.hpp"
#include "study/search_store.hpp"
#include "study/study_directory.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

/// Names of all files that an optimisation may leave beside its folders. The checkpoint first:
/// without it the others are nobody's.
std::vector<std::string> result_names() {
  return with_figures({search_file::state, search_file::evaluations, search_file::history,
                       "optimum.toml", "optimum.rules", "optimum-after.rules", "optimum.txt",
                       "optimum.json", "compare.toml", "race.csv", "report.html"},
                      {"fitness"});
}

std::string compare_in(const std::string& dir) {
  return (fs::path(dir) / "compare").string();
}

/// Whether the folder of the comparison is an optimisation's.
bool is_compared(const std::string& dir) {
  return exists((fs::path(dir) / "compare.toml").string());
}

bool is_ours(const Optimization::Source& source, const std::string& dir) {
  const std::string race = race_identity_file(dir);
  if (source.file.race) {  // the search is of a winner yet unknown
    return exists(race) && read_whole(race) == race_identity(source);
  }
  const std::string state = (fs::path(dir) / search_file::state).string();
  return !exists(race) && exists(state) &&
         is_search_of(read_whole(state), source.identity(), *source.search());
}

/// What is there under names that this optimisation is going to give, in a directory that is no
/// optimisation's.
std::vector<std::string> in_the_way(const Optimization::Source& source, const std::string& dir) {
  std::vector<std::string> files = files_of_search(dir);
  if (source.plan.replicates > 0) {
    for (std::string& file : files_of_study(compare_in(dir))) files.push_back(std::move(file));
  }
  for (const auto& contestant : source.contestants) {
    files.push_back(ruleset_file(dir, *contestant));
  }
  if (source.file.race) {
    for (const char* name : {"round-1", "last"}) {
      files.push_back((fs::path(dir) / "race" / name).string());
    }
  }
  std::erase_if(files, std::not_fn(exists));
  return files;
}

}  // namespace

std::string race_identity_file(const std::string& dir) {
  return (fs::path(dir) / "race" / "identity.txt").string();
}

std::string race_identity(const Optimization::Source& source) {
  return source.identity() + " " + std::to_string(source.file.race->rulesets) + " " +
         std::to_string(source.file.race->evaluations) + " " + std::to_string(source.plan.seed) +
         "\n";
}

std::string ruleset_file(const std::string& dir, const Optimization::Source& contestant) {
  return (fs::path(dir) / "rulesets" / (contestant.ruleset->name + ".rules")).string();
}

std::vector<std::string> files_of_search(const std::string& dir) {
  std::vector<std::string> files;
  for (const std::string& name : result_names()) files.push_back((fs::path(dir) / name).string());
  if (is_compared(dir)) {
    for (std::string& file : files_of_study(compare_in(dir))) files.push_back(std::move(file));
  }
  std::error_code ignored;
  if (exists(race_identity_file(dir))) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(dir) / "race", ignored)) {
      if (entry.is_regular_file(ignored)) files.push_back(entry.path().string());
    }
    for (const auto& entry : fs::directory_iterator(fs::path(dir) / "rulesets", ignored)) {
      if (entry.path().extension() == ".rules") files.push_back(entry.path().string());
    }
  }
  std::erase_if(files, std::not_fn(exists));
  return files;
}

void check_search_directory(const Optimization::Source& source, const std::string& dir,
                            bool force) {
  if (source.plan.replicates > 0) spare_study_file(compare_in(dir));
  if (force || is_ours(source, dir)) return;
  for (const bool race : {true, false}) {
    const std::string mark =
        race ? race_identity_file(dir) : (fs::path(dir) / search_file::state).string();
    if (!exists(mark)) continue;
    throw InputError("'" + dir + "' holds another " + (race ? "race" : "search") + kChooseAnother);
  }
  refuse_foreign(dir, in_the_way(source, dir), "search");
}

std::shared_ptr<const DirectoryLock> claim_search_directory(const Optimization::Source& source,
                                                            const std::string& dir, bool force) {
  check_search_directory(source, dir, force);  // before the directory is made
  auto lock = std::make_shared<DirectoryLock>();
  lock->take(dir);
  check_search_directory(source, dir, force);  // now that no other process can claim it
  if (!force || is_ours(source, dir)) return lock;
  const bool race = exists(race_identity_file(dir)), compared = is_compared(dir);
  std::error_code ignored;
  for (const std::string& file : files_of_search(dir)) fs::remove(file, ignored);
  if (race) fs::remove_all(fs::path(dir) / "race", ignored);
  // Unless there is something else in them.
  if (race) fs::remove(fs::path(dir) / "rulesets", ignored);
  if (compared) fs::remove(compare_in(dir), ignored);
  return lock;
}

}  // namespace lilytank
