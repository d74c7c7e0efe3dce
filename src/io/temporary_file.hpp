// A new file under a name of its own, until it is complete and takes the name of its target.
#pragma once
#include <csignal>
#include <string>
#include <string_view>

namespace lilytank {

/// The file that a name stands for: links are followed, as a shell's > does, also to one that is
/// yet to be made. The links of /proc (where /dev/stdout and /dev/fd lead) stand for open files
/// that may have no name.
std::string file_behind(const std::string& name);

/// Lies in its target's directory as ".lilytank-<target>-<host>-<number>", both as hashes. The name
/// is new: no other file is opened, truncated or removed, and no link is followed. The file is
/// locked while its process lives, so the next write of the same target recognises what a killed
/// process on this host has left, and removes it.
class TemporaryFile {
 public:
  /// Creates the file. A link at `target` is followed, and stays a link. Permissions, and where
  /// possible the owner, are those of a target that exists; those of a new one honour the umask.
  /// Throws InputError if the target cannot be written, is a directory, or is no regular file.
  explicit TemporaryFile(const std::string& target);
  /// Removes the file unless it was published.
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  const std::string& name() const { return name_; }
  /// Throws InputError with the system's reason.
  void write(std::string_view content);
  /// Hands the content to the disk, so that only the renaming is left. Throws InputError.
  void complete();
  /// Replaces the target. Throws InputError.
  void publish();
  /// Takes the target's name if no file has it; false if one has. Throws InputError.
  bool publish_as_new();

 private:
  [[noreturn]] void refuse(int number) const;
  bool create(const std::string& name, unsigned mode);
  void take_rights();
  void close();

  std::string file_, target_, name_;  ///< as the user wrote it; behind links; temporary
  int descriptor_ = -1;
  bool exists_ = false;  ///< the target, with the permissions and the owner below
  unsigned mode_ = 0, owner_ = 0, group_ = 0;
};

/// The signals that end a program in an orderly way (HUP, INT, TERM) wait while this lives, so that
/// none of them leaves a temporary file behind. They still reach other threads.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  sigset_t before_{};
};

/// Held while several files are renamed, so that two processes that write the same set leave the
/// set of one of them. A file ".lilytank-lock" in the directory, gone afterwards; without effect
/// where the file system has no locks.
class RenameLock {
 public:
  explicit RenameLock(const std::string& directory);
  ~RenameLock();
  RenameLock(RenameLock&& other) noexcept;
  RenameLock& operator=(RenameLock&&) = delete;

 private:
  std::string name_;
  int descriptor_ = -1;
};

}  // namespace lilytank
