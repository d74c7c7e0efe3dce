// A file that only grows, and can be cut back to where a checkpoint left it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "lilytank/file_digest.hpp"

namespace lilytank {

/// Collects text and appends it in large pieces. Not shared between threads.
class AppendFile {
 public:
  /// Begins an empty file, or goes on in an existing one cut to `keep_bytes` >= 0. A link in the
  /// place of a new file is replaced, not followed. Throws InputError if the file cannot be opened
  /// or is shorter than that.
  explicit AppendFile(std::string file, std::int64_t keep_bytes = -1);
  /// Goes on in a file of which the first bytes are those of `keep`, and cuts off what follows
  /// them. Throws InputError if they are not.
  AppendFile(std::string file, const FileDigest& keep);
  /// Hands over what is left; problems are then lost, so flush first.
  ~AppendFile();
  AppendFile(AppendFile&& other) noexcept;
  AppendFile& operator=(AppendFile&&) = delete;

  /// Throws InputError if the disk is full or fails.
  void append(std::string_view text);
  /// Hands everything appended so far to the system, where a kill of the program does not lose it.
  void hand_over();
  /// Everything appended so far is on the disk on return; returns the digest of it. A file that was
  /// cut to `keep_bytes` has none.
  const FileDigest& flush();

 private:
  std::string file_, waiting_;
  int descriptor_ = -1;
  FileDigest digest_;
};

}  // namespace lilytank
