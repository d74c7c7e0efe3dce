#include "cli/dry_run.hpp"

#include <filesystem>

#include "io/atomic_file.hpp"
#include "study/study_directory.hpp"

namespace lilytank::cli {

namespace fs = std::filesystem;

void check_directory_can_be(const std::string& dir) {
  std::error_code ignored;
  if (fs::exists(dir, ignored)) {
    if (fs::is_directory(dir, ignored)) return;
    throw InputError("'" + dir + "' is a file; the results need a directory");
  }
  fs::path above = fs::absolute(dir, ignored);
  while (above.has_relative_path() && !fs::exists(above, ignored)) above = above.parent_path();
  if (fs::is_directory(above, ignored)) return;
  throw InputError(system_problem("cannot make", dir, ENOTDIR));
}

void check_directory_of(const StudyPlan& plan, const std::string& dir, bool force) {
  check_directory_can_be(dir);
  check_study_directory(dir, plan, force);
}

}  // namespace lilytank::cli
