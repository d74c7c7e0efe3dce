#include "fuzz/repaired.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "io/file_digest.hpp"
#include "io/trajectory_format.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank::fuzz {

std::string hash_of(std::string_view text) {
  Fnv hash;
  hash.add(text);
  return hex(hash.value());
}

std::string with_right_rows(std::string_view bytes) {
  std::string out;
  while (!bytes.empty()) {
    const auto end = std::min(bytes.find('\n'), bytes.size());
    const std::string_view line = bytes.substr(0, end), row = line.substr(0, line.rfind(','));
    const bool header = out.empty() || row.size() == line.size();
    out += header ? std::string(line) : with_checksum(std::string(row));
    if (!header && line.ends_with(';')) out += ';';
    if (end < bytes.size()) out += '\n';
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
  }
  return out;
}

std::string with_right_last_line(std::string_view bytes) {
  return with_checksum_line(std::string(bytes.substr(0, bytes.rfind("# checksum "))));
}

std::string with_right_frames(std::string_view bytes) {
  std::string out(bytes);
  const auto seal = [&](std::size_t begin, std::size_t size) {
    const std::uint32_t sum = checksum_bits(std::string_view(out).substr(begin, size));
    std::memcpy(out.data() + begin + size, &sum, sizeof sum);
  };
  std::uint32_t bodies = 0;
  if (out.size() < kTrajectoryHeader) return out;
  std::memcpy(&bodies, out.data() + 12, sizeof bodies);
  seal(0, kTrajectoryHeader - sizeof(std::uint32_t));
  const std::size_t frame = kFrameTime + kFrameBody * std::size_t{bodies};
  for (std::size_t at = kTrajectoryHeader; at + frame + kFrameChecksum <= out.size();
       at += frame + kFrameChecksum) {
    seal(at, frame);
  }
  return out;
}

}  // namespace lilytank::fuzz
