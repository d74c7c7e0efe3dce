#include "jobs/job_directory.hpp"

#include <filesystem>

#include "io/atomic_file.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

// The first of the job's results that lies there; "" if none does.
std::string result_in(const std::string& dir, const DirectoryJob& job) {
  std::error_code ignored;
  for (const std::string& name : job.results) {
    if (fs::exists(fs::path(dir) / name, ignored)) return name;
  }
  return "";
}

}  // namespace

JobDirectory::JobDirectory(const std::string& dir, bool force, const DirectoryJob& job) {
  if (dir.empty()) return;
  lock_.take(dir);
  const fs::path work = fs::path(dir) / "work", mark = work / "identity";
  const std::string mine = "lilytank " + job.kind + " " + job.identity + "\n";
  std::error_code ignored;
  const bool claimed = fs::exists(mark, ignored);
  if (claimed && read_whole(mark.string()) == mine) return;
  const std::string advice = ": choose another --out, or replace it with --force";
  if (claimed && !force) {
    const bool alike = read_whole(mark.string()).starts_with("lilytank " + job.kind + " ");
    throw InputError(dir + " holds " +
                     (alike ? "another " + job.kind + " (other data, options or program)"
                            : "results that are not of a " + job.kind) +
                     advice);
  }
  if (const std::string name = result_in(dir, job); !name.empty() && !force) {
    throw InputError(dir + " holds a file '" + name + "' that is not of a " + job.kind + advice);
  }
  if (claimed) fs::remove_all(work, ignored);
  for (const std::string& name : job.results) fs::remove(fs::path(dir) / name, ignored);
  make_directory(work.string());
  write_atomically(mark.string(), mine);
}

std::vector<std::string> with_figures(std::vector<std::string> files,
                                      const std::vector<std::string>& figures) {
  for (const std::string& figure : figures) {
    for (const char* ending : {".png", ".svg"}) files.push_back(figure + ending);
  }
  return files;
}

}  // namespace lilytank
