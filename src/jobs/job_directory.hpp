// A directory of results that is one job's, and one process's at a time.
#pragma once
#include <string>
#include <vector>

#include "jobs/directory_lock.hpp"

namespace lilytank {

/// Whose a directory is.
struct DirectoryJob {
  std::string kind;                  ///< "calibration"
  std::string identity;              ///< of all that its results depend on
  std::vector<std::string> results;  ///< names of all files that it may leave beside `work`
};

/// Held until the object goes. A file in `work` tells whose the directory is.
class JobDirectory {
 public:
  /// Nothing if `dir` is empty. What another job left, its `work` and its results, is removed with
  /// `force`, and refused without; so are files with names of results that are nobody's. Throws
  /// InputError, also if another process is at work there.
  JobDirectory(const std::string& dir, bool force, const DirectoryJob& job);

 private:
  DirectoryLock lock_;
};

/// Names of figures as they are drawn: "maps.png" and "maps.svg" of "maps".
std::vector<std::string> with_figures(std::vector<std::string> files,
                                      const std::vector<std::string>& figures);

}  // namespace lilytank
