#include "output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "lilytank/error.hpp"

namespace lilytank {
namespace {

[[noreturn]] void refuse(const std::string& file, int error) {
  throw InputError("cannot write '" + file + "': " + std::strerror(error));
}

int open_new(const std::string& file) {
  return ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
}

// 0 or the error number.
int write_all(int descriptor, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno != EINTR) return errno;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  return 0;
}

}  // namespace

std::string unfinished_name(const std::string& file) {
  const std::filesystem::path path(file);
  const std::string name =
      "." + path.filename().string() + "." + std::to_string(::getpid()) + ".part";
  return (path.parent_path() / name).string();
}

void require_writable(const std::string& file) {
  if (std::filesystem::is_directory(file)) refuse(file, EISDIR);
  const std::string unfinished = unfinished_name(file);
  const int descriptor = open_new(unfinished);
  if (descriptor < 0) refuse(file, errno);
  ::close(descriptor);
  ::unlink(unfinished.c_str());
}

void publish(const std::string& unfinished, const std::string& file) {
  if (std::rename(unfinished.c_str(), file.c_str()) == 0) return;
  const int error = errno;
  ::unlink(unfinished.c_str());
  refuse(file, error);
}

void write_whole(const std::string& file, const std::string& bytes) {
  const std::string unfinished = unfinished_name(file);
  const int descriptor = open_new(unfinished);
  if (descriptor < 0) refuse(file, errno);
  int error = write_all(descriptor, bytes);
  // A file system may report a full disk only now.
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) {
    ::unlink(unfinished.c_str());
    refuse(file, error);
  }
  publish(unfinished, file);
}

}  // namespace lilytank
