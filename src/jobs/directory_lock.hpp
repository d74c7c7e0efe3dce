// One process at a time in a directory of results, or several that do the same work.
#pragma once
#include <string>

namespace lilytank {

/// Held until the object, or the process, ends, however it ends; leaves no file behind.
class DirectoryLock {
 public:
  DirectoryLock() = default;
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

  /// Makes the directory if absent and takes it. Throws InputError if it cannot be made or another
  /// process is at work there.
  void take(const std::string& dir);
  /// Makes the directory if absent and takes it, `shared` with others that share it, or alone; also
  /// changes the one into the other. False if another process is at work there. Throws InputError
  /// if the directory cannot be made. A file system without locks is taken for free.
  bool try_take(const std::string& dir, bool shared);

 private:
  int descriptor_ = -1;
};

}  // namespace lilytank
