#include "study/study_directory.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <map>
#include <tuple>

#include "io/atomic_file.hpp"
#include "study/row_text.hpp"
#include "study/study_record.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

bool is_rows(const std::string& name) {
  return name.starts_with(study_file::rows_prefix) && name.ends_with(".csv");
}

/// Whether a study may make a file of this name from its rows: table, statistics, figures.
bool is_made(const std::string& name) {
  static const std::vector<std::string> kNames =
      with_figures({study_file::table, "summary.txt", "summary.csv", "comparisons.csv",
                    "yield_curve.csv", "survival.csv", "report.html", "view.html"},
                   {"yield", "mean_time"});
  if (std::find(kNames.begin(), kNames.end(), name) != kNames.end()) return true;
  static const std::vector<std::string> kEndings = with_figures({}, {""});
  const auto ending = std::find_if(kEndings.begin(), kEndings.end(),
                                   [&](const std::string& e) { return name.ends_with(e); });
  if (ending == kEndings.end()) return false;
  const std::string figure = name.substr(0, name.size() - ending->size()), survival = "survival_";
  return figure.starts_with("copies_over_") ||
         (figure.starts_with(survival) && parse_whole(figure.substr(survival.size())));
}

/// Files whose names fit, sorted.
std::vector<std::string> files_that(const std::string& dir, bool (*fits)(const std::string& name)) {
  std::vector<std::string> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(dir, ignored)) {
    if (fits(entry.path().filename().string())) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> rows_files(const std::string& dir) {
  return files_that(dir, is_rows);
}

bool same(const RunRow& a, const RunRow& b) {
  const auto all = [](const RunRow& r) {
    return std::tie(r.status, r.duration, r.possible, r.copies, r.illegal, r.completion, r.note);
  };
  return all(a) == all(b);
}

std::string file_in(const std::string& dir, const std::string& name) {
  return (fs::path(dir) / name).string();
}

/// The study that a directory says to be of, if it says so.
std::optional<StudyPlan> plan_in(const std::string& dir) {
  const std::string file = file_in(dir, study_file::plan);
  if (!exists(file)) return std::nullopt;
  return read_plan(file);
}

void refuse_other(const std::string& dir, const StudyPlan& plan) {
  const auto there = plan_in(dir);
  if (there && there->identity() != plan.identity()) {
    throw InputError("'" + dir + "' holds another study ('" + there->name + "', " +
                     std::to_string(there->settings.size()) +
                     " settings, other scenarios, axes or seed)" + kChooseAnother);
  }
  std::string foreign;
  read_rows(dir, plan, foreign);
  if (!foreign.empty()) {
    throw InputError("'" + foreign + "' holds rows of another study" + kChooseAnother);
  }
  if (!there) refuse_foreign(dir, files_that(dir, is_made), "study");
}

/// Whether the plan in a directory is this study's; false if it is of an older version, or damaged.
bool is_plan_of(const std::string& dir, const StudyPlan& plan) {
  try {
    const auto there = plan_in(dir);
    return there && there->identity() == plan.identity();
  } catch (const InputError&) {
    return false;
  }
}

/// Whether all rows in a directory are this study's, too.
bool is_of(const std::string& dir, const StudyPlan& plan) {
  try {
    std::string foreign;
    read_rows(dir, plan, foreign);
    return foreign.empty() && is_plan_of(dir, plan);
  } catch (const InputError&) {
    return false;
  }
}

/// Removes what is not of this study: files of `plan` are spared.
void remove_other(const std::string& dir, const StudyPlan& plan) {
  std::error_code ignored;
  const bool ours = is_plan_of(dir, plan);
  for (const std::string& file : rows_files(dir)) {
    bool foreign = false;
    try {
      rows_from(read_whole(file), file, plan, foreign);
    } catch (const InputError&) {
      foreign = true;
    }
    if (foreign) fs::remove(file, ignored);
  }
  if (ours) return;
  for (const std::string& file : files_that(dir, is_made)) fs::remove(file, ignored);
  fs::remove(file_in(dir, study_file::plan), ignored);
}

}  // namespace

std::vector<std::string> files_of_study(const std::string& dir) {
  std::vector<std::string> files =
      files_that(dir, [](const std::string& name) { return is_rows(name) || is_made(name); });
  const std::string plan = file_in(dir, study_file::plan);
  if (exists(plan) && is_plan(read_whole(plan))) files.push_back(plan);
  return files;
}

void spare_study_file(const std::string& dir) {
  const std::string file = file_in(dir, study_file::plan);
  if (!exists(file) || is_plan(read_whole(file))) return;
  throw InputError("'" + file +
                   "' is not of a study's results and would be overwritten; choose "
                   "another --out");
}

std::vector<RunRow> read_rows(const std::string& dir, const StudyPlan& plan, std::string& foreign) {
  std::vector<RunRow> rows;
  std::map<std::string, std::size_t> known;  // by id
  for (const std::string& file : rows_files(dir)) {
    bool other = false;
    for (RunRow& row : rows_from(read_whole(file), file, plan, other)) {
      const auto [at, fresh] = known.emplace(row.id, rows.size());
      if (fresh) {
        rows.push_back(std::move(row));
      } else if (!same(rows[at->second], row)) {
        throw InputError(file + ": run " + row.id + " has another result in another rows file: " +
                         "were they made by different programs?");
      }
    }
    if (other && foreign.empty()) foreign = file;
  }
  return rows;
}

std::string claim_rows_file(const std::string& dir) {
  for (std::size_t n = rows_files(dir).size() + 1;; ++n) {
    std::string number = std::to_string(n);
    number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
    const std::string file = file_in(dir, study_file::rows_prefix + number + ".csv");
    const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (opened >= 0) {
      ::close(opened);
      return file;
    }
    if (errno != EEXIST) throw InputError(system_problem("cannot write", file, errno));
  }
}

void check_study_directory(const std::string& dir, const StudyPlan& plan, bool force) {
  std::error_code ignored;
  if (exists(dir) && !fs::is_directory(dir, ignored)) {
    throw InputError("'" + dir + "' is a file; the results need a directory");
  }
  spare_study_file(dir);
  if (!force) refuse_other(dir, plan);
}

void open_study_directory(const std::string& dir, const StudyPlan& plan, bool force,
                          DirectoryLock& lock) {
  constexpr int kMostLooks = 200;  // within 2 s: others hold the directory alone only briefly
  for (int look = 1;; ++look) {
    check_study_directory(dir, plan, force);
    const bool replaced = force && !is_of(dir, plan);
    if (lock.try_take(dir, !replaced)) break;
    if (look == kMostLooks) throw InputError("another process is at work in '" + dir + "'");
    ::usleep(10'000);
  }
  check_study_directory(dir, plan, force);  // now that nobody can begin another job here
  const std::string file = file_in(dir, study_file::plan), text = plan_text(plan);
  if (force && !is_of(dir, plan)) remove_other(dir, plan);
  if (!create_atomically(file, text)) {
    // Of two studies that begin at once one creates the plan, and the other one finds it.
    check_study_directory(dir, plan, false);
    if (read_whole(file) != text) write_atomically(file, text);
  }
  if (!lock.try_take(dir, true)) throw InputError("another process is at work in '" + dir + "'");
}

}  // namespace lilytank
