// Output directory of a job: ownership and overwriting.
//
// A directory of results belongs to one job. A file in it, the job's mark, says which:
// resolved.toml (run), study.toml (study), search.state or race/identity.txt (search),
// work/identity (all others). What another job left, and files that no job has marked as its own,
// are replaced only with --force.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "jobs/directory_lock.hpp"

namespace lilytank {

/// The end of every refusal of a directory.
inline const std::string kChooseAnother = "; choose another --out, or --force to replace it";

/// Begin of the study.toml that a study writes; study files of the user's have other first words.
inline constexpr const char* kStudyMark = "# A study's settings and rules, written by lilytank";

/// A job whose mark is work/identity.
struct DirectoryJob {
  std::string kind;                  ///< "calibration"
  std::string identity;              ///< of all that its results depend on
  std::vector<std::string> results;  ///< names of all files that it may leave beside `work`
};

/// Looks into `dir`, changing nothing. Unless `force`, throws InputError if it belongs to another
/// job or holds files with names of this job's results that no job has marked.
void check_directory(const std::string& dir, bool force, const DirectoryJob& job);

/// Makes the directory if absent, locks it, marks it, and, with `force`, removes what is not of
/// this job: the `work` of a marked directory, and results. Returns the lock, to be held until the
/// last result is written; null if `dir` is empty. Throws InputError as check_directory() does, and
/// if another process is at work there.
std::shared_ptr<const DirectoryLock> claim_directory(const std::string& dir, bool force,
                                                     const DirectoryJob& job);

/// Throws InputError if `dir` has the mark of a job of another kind than `kind` ("study"); or else
/// if there are `files` (paths of existing files).
void refuse_foreign(const std::string& dir, const std::vector<std::string>& files,
                    const std::string& kind);

/// Whether there is a file, or a directory, that can be seen.
bool exists(const std::string& file);
/// Paths of those of the named files that exist in `dir`.
std::vector<std::string> existing_in(const std::string& dir, const std::vector<std::string>& names);

/// Names of figures as they are drawn: "maps.png", "maps.svg", "maps.pdf" and "maps.caption.txt".
std::vector<std::string> with_figures(std::vector<std::string> files,
                                      const std::vector<std::string>& figures);

}  // namespace lilytank
