#include "cli/dry_run.hpp"

#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/study_record.hpp"
#include "study/study_directory.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

void refuse_other_study(const std::string& dir, const std::string& file, const StudyPlan& plan) {
  const std::string advice = "; choose another --out, or --force to replace it";
  std::error_code ignored;
  if (fs::exists(file, ignored)) {
    const StudyPlan there = read_plan(file);
    if (there.identity() != plan.identity()) {
      throw InputError("'" + dir + "' holds another study ('" + there.name + "', " +
                       std::to_string(there.settings.size()) +
                       " settings, other scenarios, axes or seed)" + advice);
    }
  }
  std::string foreign;
  read_rows(dir, plan, foreign);
  if (!foreign.empty()) throw InputError("'" + foreign + "' holds rows of another study" + advice);
}

}  // namespace

void check_directory_can_be(const std::string& dir) {
  std::error_code ignored;
  if (fs::exists(dir, ignored)) {
    if (fs::is_directory(dir, ignored)) return;
    throw InputError("'" + dir + "' is a file; the results need a directory");
  }
  fs::path above = fs::absolute(dir, ignored);
  while (above.has_relative_path() && !fs::exists(above, ignored)) above = above.parent_path();
  if (fs::is_directory(above, ignored)) return;
  throw InputError(system_problem("cannot make directory", dir, ENOTDIR));
}

void check_study_directory(const std::string& dir, const StudyPlan& plan, bool force) {
  check_directory_can_be(dir);
  const std::string file = (fs::path(dir) / study_file::plan).string();
  std::error_code ignored;
  if (fs::exists(file, ignored) && !is_plan(read_whole(file))) {
    throw InputError("'" + file +
                     "' is not of a study's results and would be overwritten; choose "
                     "another --out");
  }
  if (!force) refuse_other_study(dir, file, plan);
}

}  // namespace lilytank::cli
