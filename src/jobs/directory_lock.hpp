// One process at a time in a directory of results.
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

 private:
  int descriptor_ = -1;
};

}  // namespace lilytank
