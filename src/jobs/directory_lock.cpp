#include "jobs/directory_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "io/atomic_file.hpp"
#include "lilytank/error.hpp"

namespace lilytank {

DirectoryLock::~DirectoryLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void DirectoryLock::take(const std::string& dir) {
  if (!try_take(dir, false)) throw InputError("another process is at work in '" + dir + "'");
}

bool DirectoryLock::try_take(const std::string& dir, bool shared) {
  if (descriptor_ < 0) {
    make_directory(dir);
    descriptor_ = ::open(dir.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  }
  if (descriptor_ < 0) return true;
  // A file system without locks is no reason to stop.
  return ::flock(descriptor_, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

}  // namespace lilytank
