#include "jobs/job_directory.hpp"

#include <filesystem>

#include "io/atomic_file.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

std::string with_article(const std::string& kind) {
  const bool vowel = std::string("aeiou").find(kind.front()) != std::string::npos;
  return (vowel ? "an " : "a ") + kind;
}

/// The text of work/identity, "lilytank <kind> <identity>"; "" if there is none.
std::string job_mark_in(const std::string& dir) {
  const fs::path mark = fs::path(dir) / "work" / "identity";
  return exists(mark.string()) ? read_whole(mark.string()) : "";
}

std::string mark_words(const std::string& kind) {
  return "lilytank " + kind + " ";
}

/// The first job of another kind whose mark is in `dir`; "" if there is none.
std::string other_kind_in(const std::string& dir, const std::string& kind) {
  static const struct {
    const char *mark, *kind, *begin;
  } kMarks[] = {{"resolved.toml", "run", ""},
                {"study.toml", "study", kStudyMark},
                {"search.state", "search", ""},
                {"race/identity.txt", "search", ""}};
  for (const auto& [mark, of, begin] : kMarks) {
    if (kind == of) continue;
    for (const std::string& file : existing_in(dir, {mark})) {
      if (read_whole(file).starts_with(begin)) return of;
    }
  }
  const std::string identity = job_mark_in(dir);
  if (identity.empty() || identity.starts_with(mark_words(kind))) return "";
  const std::size_t begin = mark_words("").size() - 1;
  return identity.substr(begin, identity.find(' ', begin) - begin);
}

}  // namespace

void check_directory(const std::string& dir, bool force, const DirectoryJob& job) {
  if (dir.empty() || force) return;
  const std::string there = job_mark_in(dir), words = mark_words(job.kind);
  if (there == words + job.identity + "\n") return;
  if (there.starts_with(words)) {
    throw InputError("'" + dir + "' holds another " + job.kind +
                     " (other data, options or program)" + kChooseAnother);
  }
  refuse_foreign(dir, existing_in(dir, job.results), job.kind);
}

std::shared_ptr<const DirectoryLock> claim_directory(const std::string& dir, bool force,
                                                     const DirectoryJob& job) {
  if (dir.empty()) return nullptr;
  check_directory(dir, force, job);  // before the directory is made
  auto lock = std::make_shared<DirectoryLock>();
  lock->take(dir);
  check_directory(dir, force, job);  // now that no other process can claim it
  const std::string mark = mark_words(job.kind) + job.identity + "\n", there = job_mark_in(dir);
  if (there == mark) return lock;
  const fs::path work = fs::path(dir) / "work";
  std::error_code ignored;
  if (!there.empty()) fs::remove_all(work, ignored);
  for (const std::string& file : existing_in(dir, job.results)) fs::remove(file, ignored);
  make_directory(work.string());
  write_atomically((work / "identity").string(), mark);
  return lock;
}

void refuse_foreign(const std::string& dir, const std::vector<std::string>& files,
                    const std::string& kind) {
  const std::string other = other_kind_in(dir, kind);
  if (!other.empty()) {
    throw InputError("'" + dir + "' holds " + with_article(other) + kChooseAnother);
  }
  if (files.empty()) return;
  const std::string name = fs::path(files.front()).lexically_relative(dir).string();
  throw InputError("'" + dir + "' holds a file '" + name + "' that is not of " +
                   with_article(kind) + kChooseAnother);
}

bool exists(const std::string& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

std::vector<std::string> existing_in(const std::string& dir,
                                     const std::vector<std::string>& names) {
  std::vector<std::string> files;
  for (const std::string& name : names) {
    std::string file = (fs::path(dir) / name).string();
    if (exists(file)) files.push_back(std::move(file));
  }
  return files;
}

std::vector<std::string> with_figures(std::vector<std::string> files,
                                      const std::vector<std::string>& figures) {
  for (const std::string& figure : figures) {
    for (const char* ending : {".png", ".svg", ".pdf", ".caption.txt"}) {
      files.push_back(figure + ending);
    }
  }
  return files;
}

}  // namespace lilytank
