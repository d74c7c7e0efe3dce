#include "jobs/directory_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "lilytank/error.hpp"

namespace lilytank {

DirectoryLock::~DirectoryLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void DirectoryLock::take(const std::string& dir) {
  std::error_code problem;
  std::filesystem::create_directories(dir, problem);
  if (problem) throw InputError("cannot make directory '" + dir + "': " + problem.message());
  descriptor_ = ::open(dir.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  // A file system without locks is no reason to stop.
  if (errno == EWOULDBLOCK) throw InputError("another process is at work in '" + dir + "'");
}

}  // namespace lilytank
