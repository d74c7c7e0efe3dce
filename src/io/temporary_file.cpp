#include "io/temporary_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "io/atomic_file.hpp"
#include "text/fnv.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

// A mark of our temporary files: the sticky bit has no effect on a file and nobody else sets it.
constexpr mode_t kOurs = S_ISVTX;
constexpr int kSwept = 8;          // names that are always checked for leftovers
constexpr int kMostNames = 10000;  // temporary files of one target at a time

std::string hashed(const std::string& text) {
  Fnv hash;
  hash.add(text);
  return std::to_string(hash.value());
}

std::string temporary_name(const fs::path& target, int number) {
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  const std::string name = ".lilytank-" + hashed(target.filename().string()) + "-" + hashed(host);
  return (target.parent_path() / (name + "-" + std::to_string(number))).string();
}

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Whether an open file still has this name.
bool has_name(int descriptor, const std::string& name) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::lstat(name.c_str(), &named) == 0 &&
         is_same(open, named);
}

/// Removes a temporary file of a process that has ended: it has our mark and our owner, and the
/// lock that its process would hold is free. Anything else of that name stays. Whoever holds the
/// lock is alone in renaming or removing the file.
bool remove_leftover(const std::string& name) {
  const int opened = ::open(name.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (opened < 0) return false;
  struct stat there {};
  const bool ours = ::fstat(opened, &there) == 0 && S_ISREG(there.st_mode) &&
                    (there.st_mode & kOurs) != 0 && there.st_uid == ::geteuid();
  const bool left = ours && ::flock(opened, LOCK_EX | LOCK_NB) == 0 && has_name(opened, name);
  const bool removed = left && ::unlink(name.c_str()) == 0;
  ::close(opened);
  return removed;
}

/// Makes a rename last through a power cut; some file systems refuse, which does no harm.
void sync_directory(const fs::path& directory) {
  const int opened =
      ::open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return;
  ::fsync(opened);
  ::close(opened);
}

}  // namespace

std::string file_behind(const std::string& name) {
  fs::path file = name;
  std::error_code ignored;
  for (int links = 0; links < 40; ++links) {
    const fs::path in = fs::canonical(file.has_parent_path() ? file.parent_path() : ".", ignored);
    if (!ignored) file = in / file.filename();
    if (!fs::is_symlink(file, ignored) || file.native().starts_with("/proc/")) break;
    file = file.parent_path() / fs::read_symlink(file, ignored);
  }
  return file.string();
}

TemporaryFile::TemporaryFile(const std::string& target)
    : file_(target), target_(file_behind(target)) {
  struct stat there {};
  if (::stat(file_.c_str(), &there) == 0) {
    if (S_ISDIR(there.st_mode)) refuse(EISDIR);
    if (!S_ISREG(there.st_mode)) throw InputError("'" + file_ + "' is no regular file");
    if (::faccessat(AT_FDCWD, target_.c_str(), W_OK, AT_EACCESS) != 0) refuse(errno);
    mode_ = there.st_mode & 07777 & ~kOurs, exists_ = true;
    owner_ = there.st_uid, group_ = there.st_gid;
  } else if (errno != ENOENT) {
    refuse(errno);
  }
  // Nobody may read here what they may not read there.
  const unsigned mode = exists_ ? 0600 : 0666;
  int number = 0;
  while (!create(temporary_name(target_, number), mode)) {
    if (++number == kMostNames) refuse(EEXIST);
  }
  for (bool more = true; more || number < kSwept;) {
    const std::string name = temporary_name(target_, ++number);
    struct stat left {};
    more = number < kMostNames && ::lstat(name.c_str(), &left) == 0;
    if (more) remove_leftover(name);
  }
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : file_(std::move(other.file_)),
      target_(std::move(other.target_)),
      name_(std::move(other.name_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      exists_(other.exists_),
      mode_(other.mode_),
      owner_(other.owner_),
      group_(other.group_) {}

TemporaryFile::~TemporaryFile() {
  if (descriptor_ < 0) return;
  ::unlink(name_.c_str());
  close();
}

void TemporaryFile::refuse(int number) const {
  throw InputError(system_problem("cannot write", file_, number));
}

void TemporaryFile::close() {
  ::close(std::exchange(descriptor_, -1));
}

bool TemporaryFile::create(const std::string& name, unsigned mode) {
  const auto open = [&] {
    return ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode | kOurs);
  };
  descriptor_ = open();
  if (descriptor_ < 0 && errno == EEXIST) {
    if (!remove_leftover(name)) return false;
    descriptor_ = open();
  }
  if (descriptor_ < 0 && errno == EEXIST) return false;
  if (descriptor_ < 0) refuse(errno);
  name_ = name;
  // Another process may have taken it for a leftover before it was locked; that one removes it. A
  // file system without locks keeps leftovers.
  const bool busy = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (!busy && has_name(descriptor_, name)) return true;
  close();
  return false;
}

void TemporaryFile::write(std::string_view content) {
  if (const int problem = write_all(descriptor_, content); problem != 0) refuse(problem);
}

void TemporaryFile::complete() {
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) refuse(errno);
  struct stat now {};
  if (::fstat(descriptor_, &now) != 0) refuse(errno);
  if (!exists_) mode_ = now.st_mode & 0777;
  if (!exists_ || (now.st_uid == owner_ && now.st_gid == group_)) return;
  if (::fchown(descriptor_, owner_, group_) == 0) return;
  // Another group must not get the rights that the target's has.
  if (::fchown(descriptor_, static_cast<uid_t>(-1), group_) != 0) {
    mode_ = (mode_ & 0707) | (mode_ & 070 & ((mode_ & 07) << 3));
  }
  mode_ &= 0777;
}

void TemporaryFile::take_rights() {
  ::fchmod(descriptor_, mode_);
  close();
  sync_directory(fs::path(target_).parent_path());
}

void TemporaryFile::publish() {
  // With the mark until it is renamed: killed here, it is still known as ours.
  ::fchmod(descriptor_, mode_ | kOurs);
  if (std::rename(name_.c_str(), target_.c_str()) != 0) refuse(errno);
  take_rights();
}

bool TemporaryFile::publish_as_new() {
  if (::link(name_.c_str(), target_.c_str()) == 0) {
    ::unlink(name_.c_str());
  } else {
    if (errno == EEXIST) return false;
    // A file system without hard links.
    if (::renameat2(AT_FDCWD, name_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) != 0) {
      if (errno == EEXIST) return false;
      refuse(errno);
    }
  }
  take_rights();
  return true;
}

HeldSignals::HeldSignals() {
  sigset_t held;
  sigemptyset(&held);
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) sigaddset(&held, signal);
  ::pthread_sigmask(SIG_BLOCK, &held, &before_);
}

HeldSignals::~HeldSignals() {
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

RenameLock::RenameLock(const std::string& directory)
    : name_((fs::path(directory) / ".lilytank-lock").string()) {
  for (;;) {
    descriptor_ = ::open(name_.c_str(), O_RDONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC,
                         0666 | kOurs);
    if (descriptor_ < 0) return;
    struct stat there {};
    const bool ours = ::fstat(descriptor_, &there) == 0 && (there.st_mode & kOurs) != 0;
    int problem = EINVAL;
    while (ours && (problem = ::flock(descriptor_, LOCK_EX) == 0 ? 0 : errno) == EINTR) {
    }
    if (problem == 0 && has_name(descriptor_, name_)) return;
    ::close(std::exchange(descriptor_, -1));
    if (problem != 0) return;
  }
}

RenameLock::RenameLock(RenameLock&& other) noexcept
    : name_(std::move(other.name_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

RenameLock::~RenameLock() {
  if (descriptor_ < 0) return;
  ::unlink(name_.c_str());
  ::close(descriptor_);
}

}  // namespace lilytank
