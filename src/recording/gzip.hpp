// Texts as gzip files.
#pragma once
#include <string>
#include <string_view>

namespace lilytank {

/// The bytes of a .gz file; the same for the same text.
std::string gzipped(std::string_view text);

}  // namespace lilytank
