#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

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

/// 0, or errno's value.
int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = ::write(descriptor, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(n));
  }
  return 0;
}

/// Makes a rename last through a power cut; some file systems refuse, which does no harm.
void sync_directory(const std::filesystem::path& directory) {
  const Descriptor opened(
      ::open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.number() >= 0) ::fsync(opened.number());
}

/// The file that a name stands for: links are followed, as a shell's > does, also to one that is
/// yet to be made. The links of /proc (where /dev/stdout and /dev/fd lead) stand for open files
/// that may have no name.
std::filesystem::path file_behind(std::filesystem::path file) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  for (int links = 0; links < 40; ++links) {
    const fs::path in = fs::canonical(file.has_parent_path() ? file.parent_path() : ".", ignored);
    if (!ignored) file = in / file.filename();
    if (!fs::is_symlink(file, ignored) || file.native().starts_with("/proc/")) break;
    file = file.parent_path() / fs::read_symlink(file, ignored);
  }
  return file;
}

/// Whether a name is of no file that another could take the place of: a device, a pipe, an open
/// file. Throws InputError where nothing can be written.
bool is_written_through(const std::string& file) {
  struct stat there {};
  if (::stat(file.c_str(), &there) != 0) {
    if (errno == ENOENT) return false;
    throw InputError(system_problem("cannot write", file, errno));
  }
  if (S_ISDIR(there.st_mode)) throw InputError(system_problem("cannot write", file, EISDIR));
  return !S_ISREG(there.st_mode) || file_behind(file).native().starts_with("/proc/");
}

void write_through(const std::string& file, std::string_view content) {
  const Descriptor opened(::open(file.c_str(), O_WRONLY | O_APPEND | O_NOCTTY | O_CLOEXEC));
  const int problem = opened.number() < 0 ? errno : write_all(opened.number(), content);
  if (problem != 0) throw InputError(system_problem("cannot write", file, problem));
}

}  // namespace

std::string system_problem(const std::string& what, const std::string& file, int number) {
  return what + " '" + file + "': " + std::generic_category().message(number);
}

void write_atomically(const std::string& file, std::string_view content) {
  if (is_written_through(file)) return write_through(file, content);
  const std::filesystem::path target = file_behind(file);
  const std::string temporary = target.string() + ".tmp";
  int problem = 0;
  {
    const Descriptor opened(
        ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (opened.number() < 0) throw InputError(system_problem("cannot write", file, errno));
    problem = write_all(opened.number(), content);
    if (problem == 0 && ::fsync(opened.number()) != 0) problem = errno;
  }
  if (problem == 0 && std::rename(temporary.c_str(), target.c_str()) != 0) problem = errno;
  if (problem != 0) {
    ::unlink(temporary.c_str());
    throw InputError(system_problem("cannot write", file, problem));
  }
  sync_directory(target.parent_path());
}

void make_directory(const std::string& dir) {
  std::error_code problem;
  std::filesystem::create_directories(dir, problem);
  if (problem) throw InputError(system_problem("cannot make", dir, problem.value()));
}

std::vector<std::string> write_files(
    const std::string& dir, const std::vector<std::pair<std::string, std::string>>& files) {
  make_directory(dir);
  std::vector<std::string> names;
  for (const auto& [name, content] : files) {
    write_atomically((std::filesystem::path(dir) / name).string(), content);
    names.push_back(name);
  }
  return names;
}

std::string read_whole(const std::string& file, const SourcePlace& asked_by) {
  const auto refuse = [&](int number) -> InputError {
    const std::string message = system_problem("cannot read", file, number);
    return asked_by.file.empty() ? InputError(message) : InputError(asked_by, message);
  };
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
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
