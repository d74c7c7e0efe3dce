// Output directory of a study: ownership, stored rows, and new rows.
//
// Every process writes a rows file of its own, begun with its first row and never touched by
// another, so any number of processes, on any machines that share the directory, may come and go. A
// file is only ever appended to, one line a run.
#pragma once
#include <string>
#include <vector>

#include "jobs/job_directory.hpp"
#include "lilytank/study.hpp"

namespace lilytank {

namespace study_file {
inline constexpr const char* plan = "study.toml";
inline constexpr const char* table = "table.csv";
inline constexpr const char* rows_prefix = "rows-";  ///< "rows-0001.csv"
}  // namespace study_file

/// Paths of what a study has left in a directory, and of files that have such names.
std::vector<std::string> files_of_study(const std::string& dir);
/// Throws InputError if a study would put its own file in the place of a study file of the user's.
void spare_study_file(const std::string& dir);

/// The rows of `plan` in a directory, each run once, in no particular order; none if there is no
/// directory. Throws InputError if a file is damaged, or if a run has two different results.
/// `foreign`: the name of a file with rows of another study, or "".
std::vector<RunRow> read_rows(const std::string& dir, const StudyPlan& plan, std::string& foreign);

/// Looks into a directory, changing nothing. Throws InputError if it is a file or holds a study
/// file of the user's; and, unless `force`, if it is another study's, a run's, or holds files with
/// names of results that are nobody's.
void check_study_directory(const std::string& dir, const StudyPlan& plan, bool force);

/// Makes the directory and stores the plan in it. The lock is shared by all processes of this study
/// and keeps out other jobs, `force` included. Throws InputError as check_study_directory() does,
/// and if another job is at work there; with `force` results that are not this study's are removed.
void open_study_directory(const std::string& dir, const StudyPlan& plan, bool force,
                          DirectoryLock& lock);

/// Makes a rows file with the next free number, which no other process has, and returns its path.
std::string claim_rows_file(const std::string& dir);

}  // namespace lilytank
