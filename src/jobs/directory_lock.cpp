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
  make_directory(dir);
  descriptor_ = ::open(dir.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  // A file system without locks is no reason to stop.
  if (errno == EWOULDBLOCK) throw InputError("another process is at work in '" + dir + "'");
}

}  // namespace lilytank
