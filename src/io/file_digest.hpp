// Digests of files that grow, and checksums of rows: results that were changed are never believed.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "lilytank/file_digest.hpp"

namespace lilytank {

/// Appends bytes to what a digest covers.
void extend(FileDigest& digest, std::string_view bytes);

/// Compares the first `digest.length` bytes of `file` with the digest. `whole`: the file ends
/// there. Throws InputError with the file, the bytes between which it differs, and `advice`, or if
/// the file is missing or shorter, or longer though `whole`.
void check_digest(const std::string& file, const FileDigest& digest, bool whole,
                  const std::string& advice);

/// Eight hexadecimal digits: the lower half of FNV-1a. Any single changed byte changes them.
std::string checksum(std::string_view bytes);
std::uint32_t checksum_bits(std::string_view bytes);

/// A row of a table with its checksum as a last cell; the table's header ends with kChecksumColumn.
std::string with_checksum(const std::string& row);
inline constexpr std::string_view kChecksumColumn = ",checksum";

/// A text file with a last line "# checksum 0123abcd" over all before it.
std::string with_checksum_line(const std::string& text);
/// The text before that line. Throws InputError with the file and `advice` if it is missing or does
/// not fit: the file was changed or cut.
std::string_view without_checksum_line(std::string_view text, const std::string& file,
                                       const std::string& advice);

}  // namespace lilytank
