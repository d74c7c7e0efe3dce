#include "io/file_digest.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>

#include "io/atomic_file.hpp"
#include "lilytank/state.hpp"
#include "text/fnv.hpp"

namespace lilytank {
namespace {

const std::string kLine = "# checksum ";

[[noreturn]] void refuse(const std::string& file, std::int64_t from, std::int64_t to,
                         const std::string& advice) {
  throw InputError({file}, "bytes " + std::to_string(from) + " to " + std::to_string(to - 1) +
                               " were changed since they were written; " + advice);
}

}  // namespace

void extend(FileDigest& digest, std::string_view bytes) {
  while (!bytes.empty()) {
    const std::int64_t room = kDigestBlock - digest.length % kDigestBlock;
    const auto size = std::min(bytes.size(), static_cast<std::size_t>(room));
    digest.value = fnv_bytes(bytes.substr(0, size), digest.value);
    digest.length += static_cast<std::int64_t>(size);
    if (digest.length % kDigestBlock == 0) digest.blocks.push_back(digest.value);
    bytes.remove_prefix(size);
  }
}

void check_digest(const std::string& file, const FileDigest& digest, bool whole,
                  const std::string& advice) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                           &std::fclose);
  if (in == nullptr) throw InputError(system_problem("cannot read", file, errno) + "; " + advice);
  FileDigest there;
  std::string block(static_cast<std::size_t>(kDigestBlock), '\0');
  while (there.length < digest.length) {
    const std::int64_t from = there.length, left = std::min(digest.length - from, kDigestBlock);
    const std::size_t n = std::fread(block.data(), 1, static_cast<std::size_t>(left), in.get());
    if (static_cast<std::int64_t>(n) < left) {
      throw InputError({file},
                       "the file is cut: " + std::to_string(from + static_cast<std::int64_t>(n)) +
                           " of " + std::to_string(digest.length) + " bytes; " + advice);
    }
    extend(there, std::string_view(block).substr(0, n));
    const auto full = static_cast<std::size_t>(there.length / kDigestBlock);
    const bool ended = there.length == digest.length;
    const std::uint64_t expected = ended                          ? digest.value
                                   : full <= digest.blocks.size() ? digest.blocks[full - 1]
                                                                  : there.value + 1;
    if (there.value != expected) refuse(file, from, there.length, advice);
  }
  if (whole && std::fgetc(in.get()) != EOF) {
    throw InputError({file}, "the file is longer than the " + std::to_string(digest.length) +
                                 " bytes that were written; " + advice);
  }
}

std::uint32_t checksum_bits(std::string_view bytes) {
  return static_cast<std::uint32_t>(fnv_bytes(bytes));
}

std::string checksum(std::string_view bytes) {
  return hex(checksum_bits(bytes)).substr(8);
}

std::string with_checksum(const std::string& row) {
  return row + "," + checksum(row);
}

std::string with_checksum_line(const std::string& text) {
  return text + kLine + checksum(text) + "\n";
}

std::string_view without_checksum_line(std::string_view text, const std::string& file,
                                       const std::string& advice) {
  const auto at = text.rfind(kLine);
  const std::string_view before = text.substr(0, at);
  if (at != std::string_view::npos && text.substr(at) == kLine + checksum(before) + "\n") {
    return before;
  }
  throw InputError({file},
                   "the file was changed or cut since it was written (its last line, the "
                   "checksum, does not fit); " +
                       advice);
}

}  // namespace lilytank
