#include "io/append_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/file_digest.hpp"

namespace lilytank {
namespace {
constexpr std::size_t kPiece = 1 << 18;  // bytes
const std::string kBeginAgain = "--force begins the run again";

/// Emptying a file must empty no other one: a link, or one of several names of a file, is removed.
void remove_if_shared(const std::string& file) {
  struct stat there {};
  if (::lstat(file.c_str(), &there) != 0) return;
  if (S_ISLNK(there.st_mode) || there.st_nlink > 1) ::unlink(file.c_str());
}
}  // namespace

AppendFile::AppendFile(std::string file, std::int64_t keep_bytes) : file_(std::move(file)) {
  if (keep_bytes < 0) remove_if_shared(file_);
  const int fresh = keep_bytes < 0 ? O_CREAT | O_TRUNC | O_NOFOLLOW : 0;
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CLOEXEC | fresh, 0666);
  if (descriptor_ < 0) throw InputError(system_problem("cannot write", file_, errno));
  if (keep_bytes < 0) return;
  struct stat now {};
  const bool known = ::fstat(descriptor_, &now) == 0;
  if (!known || now.st_size < keep_bytes || ::ftruncate(descriptor_, keep_bytes) != 0 ||
      ::lseek(descriptor_, keep_bytes, SEEK_SET) != keep_bytes) {
    ::close(std::exchange(descriptor_, -1));
    throw InputError("'" + file_ + "' is shorter than its checkpoint says: it was changed");
  }
}

AppendFile::AppendFile(std::string file, const FileDigest& keep)
    : AppendFile((check_digest(file, keep, false, kBeginAgain), std::move(file)), keep.length) {
  digest_ = keep;
}

AppendFile::AppendFile(AppendFile&& other) noexcept
    : file_(std::move(other.file_)),
      waiting_(std::move(other.waiting_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      digest_(std::move(other.digest_)) {}

AppendFile::~AppendFile() {
  if (descriptor_ < 0) return;
  try {
    hand_over();
  } catch (const InputError&) {  // a destructor cannot report it
  }
  ::close(descriptor_);
}

void AppendFile::append(std::string_view text) {
  waiting_ += text;
  if (waiting_.size() >= kPiece) hand_over();
}

void AppendFile::hand_over() {
  extend(digest_, waiting_);
  const int problem = write_all(descriptor_, waiting_);
  if (problem != 0) throw InputError(system_problem("cannot write", file_, problem));
  waiting_.clear();
}

const FileDigest& AppendFile::flush() {
  hand_over();
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) {
    throw InputError(system_problem("cannot write", file_, errno));
  }
  return digest_;
}

}  // namespace lilytank
