#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <set>
#include <system_error>

#include "io/standard_input.hpp"
#include "io/temporary_file.hpp"

namespace lilytank {
namespace {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// Whether a name is of no file that another could take the place of: a device, a pipe, an open
/// file. Throws InputError where nothing can be written.
bool is_written_through(const std::string& file) {
  struct stat there {};
  if (::stat(file.c_str(), &there) != 0) {
    if (errno == ENOENT) return false;
    throw InputError(system_problem("cannot write", file, errno));
  }
  if (S_ISDIR(there.st_mode)) throw InputError(system_problem("cannot write", file, EISDIR));
  return !S_ISREG(there.st_mode) || file_behind(file).starts_with("/proc/");
}

void write_through(const std::string& file, std::string_view content) {
  const Descriptor opened(::open(file.c_str(), O_WRONLY | O_APPEND | O_NOCTTY | O_CLOEXEC));
  const int problem = opened.number() < 0 ? errno : write_all(opened.number(), content);
  if (problem != 0) throw InputError(system_problem("cannot write", file, problem));
}

/// A complete file, to be published.
TemporaryFile written(const std::string& file, std::string_view content) {
  TemporaryFile temporary(file);
  temporary.write(content);
  temporary.complete();
  return temporary;
}

}  // namespace

int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = ::write(descriptor, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(n));
  }
  return 0;
}

namespace {

// The nearest name in the directory of a file that is not there, among those of its kind.
std::string nearest_in_directory(const std::string& file) {
  const std::filesystem::path path(file);
  const std::filesystem::path in = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code ignored;
  std::vector<std::string> stems;
  for (const auto& entry : std::filesystem::directory_iterator(in, ignored)) {
    const std::filesystem::path& other = entry.path();
    if (other.extension() == path.extension()) stems.push_back(other.stem().string());
  }
  std::sort(stems.begin(), stems.end());
  std::string advice = did_you_mean(path.stem().string(), stems);
  if (const auto end = advice.rfind("'?"); end != std::string::npos) {
    advice.insert(end, path.extension().string());
  }
  return advice;
}

}  // namespace

std::string system_problem(const std::string& what, const std::string& file, int number) {
  return what + " '" + file + "': " + std::generic_category().message(number) +
         (number == ENOENT ? nearest_in_directory(file) : "");
}

void require_path(const std::string& path) {
  std::error_code ignored;
  if (path == kStandardInput || std::filesystem::exists(path, ignored)) return;
  throw InputError(system_problem("cannot read", path, ENOENT));
}

void write_atomically(const std::string& file, std::string_view content) {
  if (is_written_through(file)) return write_through(file, content);
  const HeldSignals held;
  written(file, content).publish();
}

bool holds_other(const std::string& file, std::string_view content) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored) && !is_written_through(file) &&
         read_whole(file) != content;
}

void refuse_to_replace(const std::string& file) {
  throw InputError("'" + file +
                   "' exists with other contents; choose another name, or --force to replace it");
}

void write_results(const NamedContents& files, bool force) {
  const auto check = [&] {
    for (const auto& [file, content] : files) {
      if (!force && holds_other(file, content)) refuse_to_replace(file);
    }
  };
  check();
  const HeldSignals held;
  std::vector<TemporaryFile> complete;
  std::set<std::string> directories;  // in one order, so that no two processes wait for each other
  for (const auto& [file, content] : files) {
    if (is_written_through(file)) continue;
    complete.push_back(written(file, content));
    directories.insert(std::filesystem::path(file_behind(file)).parent_path().string());
  }
  for (const auto& [file, content] : files) {
    if (is_written_through(file)) write_through(file, content);
  }
  std::vector<RenameLock> locks;
  for (const std::string& directory : directories) locks.emplace_back(directory);
  check();  // another process may have written one meanwhile
  for (TemporaryFile& file : complete) file.publish();
}

void write_together(const NamedContents& files) {
  write_results(files, true);
}

bool create_atomically(const std::string& file, std::string_view content) {
  const HeldSignals held;
  return written(file, content).publish_as_new();
}

void make_directory(const std::string& dir) {
  std::error_code problem;
  std::filesystem::create_directories(dir, problem);
  if (problem) throw InputError(system_problem("cannot make", dir, problem.value()));
}

std::vector<std::string> write_files(const std::string& dir, const NamedContents& files) {
  make_directory(dir);
  std::vector<std::string> names;
  NamedContents paths;
  for (const auto& [name, content] : files) {
    paths.emplace_back((std::filesystem::path(dir) / name).string(), content);
    names.push_back(name);
  }
  write_together(paths);
  return names;
}

std::string read_whole(const std::string& file, const SourcePlace& asked_by) {
  const auto refuse = [&](int number) -> InputError {
    const std::string message = system_problem("cannot read", file, number);
    return asked_by.file.empty() ? InputError(message) : InputError(asked_by, message);
  };
  const Descriptor opened(::open(openable(file).c_str(), O_RDONLY | O_CLOEXEC));
  if (opened.number() < 0) throw refuse(errno);
  std::string content;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t n = ::read(opened.number(), buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw refuse(errno);
    if (n == 0) return content;
    content.append(buffer, static_cast<std::size_t>(n));
  }
}

}  // namespace lilytank
