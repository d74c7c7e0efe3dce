// Bytes with their checksums made right, or damage would never come further than these.
#pragma once
#include <string>
#include <string_view>

namespace lilytank::fuzz {

/// Hash of a text in hexadecimal digits, as in checkpoints.
std::string hash_of(std::string_view text);
/// Rows that end with ",checksum"; kept rows with ";" behind it.
std::string with_right_rows(std::string_view bytes);
/// A text with a last line of its checksum.
std::string with_right_last_line(std::string_view bytes);
/// A binary trajectory.
std::string with_right_frames(std::string_view bytes);

/// Reads bytes as they are, and repaired.
template <class Read>
bool with_repair(std::string_view bytes, std::string (*repaired)(std::string_view), Read read) {
  const bool as_is = read(bytes);
  return read(repaired(bytes)) || as_is;
}

}  // namespace lilytank::fuzz
