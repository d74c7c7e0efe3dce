#include "io/standard_input.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/line_source.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

// Whether standard input is a file in memory, which can be opened more than once: only those have
// seals.
bool is_stored() {
  return ::fcntl(STDIN_FILENO, F_GET_SEALS) >= 0;
}

// Puts a file in memory with its contents in the place of standard input.
void store() {
  const int contents = ::memfd_create("stdin", MFD_CLOEXEC);
  int problem = contents < 0 ? errno : 0;
  char buffer[1 << 16];
  for (ssize_t n = 1; n != 0 && problem == 0;) {
    n = ::read(STDIN_FILENO, buffer, sizeof buffer);
    if (n > 0) problem = write_all(contents, {buffer, static_cast<std::size_t>(n)});
    if (n < 0 && errno != EINTR) problem = errno;
  }
  if (problem == 0 && ::dup2(contents, STDIN_FILENO) < 0) problem = errno;
  if (contents >= 0) ::close(contents);
  if (problem != 0) throw InputError(system_problem("cannot read", kStandardInput, problem));
}

}  // namespace

std::string openable(const std::string& file) {
  if (file != kStandardInput) return file;
  if (!is_stored()) store();
  return "/dev/fd/0";
}

std::string stem_of(const std::string& file) {
  return file == kStandardInput ? "stdin" : std::filesystem::path(file).stem().string();
}

bool is_toml(const std::string& file) {
  if (file != kStandardInput) return file.ends_with(".toml");
  LineSource lines(file);
  for (std::string_view line; lines.next(line);) {
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    return line.front() == '[' || line.find(" = ") != line.npos;
  }
  return false;
}

}  // namespace lilytank
