#include "output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "io/atomic_file.hpp"

namespace lilytank {

std::string unfinished_name(const std::string& file) {
  const std::filesystem::path path(file);
  std::string name = ".";
  name += path.filename().string();
  name += '.';
  name += std::to_string(::getpid());
  name += ".part";
  return (path.parent_path() / name).string();
}

void require_writable(const std::string& file) {
  const auto refuse = [&](int number) {
    throw InputError(system_problem("cannot write", file, number));
  };
  if (std::filesystem::is_directory(file)) refuse(EISDIR);
  const std::string unfinished = unfinished_name(file);
  const int descriptor = ::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) refuse(errno);
  ::close(descriptor);
  ::unlink(unfinished.c_str());
}

void publish(const std::string& unfinished, const std::string& file) {
  if (std::rename(unfinished.c_str(), file.c_str()) == 0) return;
  const int number = errno;
  ::unlink(unfinished.c_str());
  throw InputError(system_problem("cannot write", file, number));
}

}  // namespace lilytank
