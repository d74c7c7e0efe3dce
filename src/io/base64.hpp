#pragma once
#include <string>
#include <string_view>

namespace lilytank {

/// Bytes as base64 [RFC 4648] in one line.
std::string base64(std::string_view bytes);

}  // namespace lilytank
