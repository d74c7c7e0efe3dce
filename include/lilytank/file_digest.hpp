// What a file held when it was last written, so that a later change is found.
#pragma once
#include <cstdint>
#include <vector>

namespace lilytank {

/// A running hash (FNV-1a, 64 bits) of the first `length` bytes of a file. Any changed byte changes
/// it.
struct FileDigest {
  /// Bytes hashed.
  std::int64_t length = 0;
  /// Hash of all of them; FNV's offset basis for none.
  std::uint64_t value = 0xcbf29ce484222325;
  /// The value after each full kDigestBlock bytes.
  std::vector<std::uint64_t> blocks;
  /// Equal lengths and hashes.
  bool operator==(const FileDigest&) const = default;
};

/// How closely a change is located (bytes).
inline constexpr std::int64_t kDigestBlock = 1 << 16;

}  // namespace lilytank
