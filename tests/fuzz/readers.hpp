// What the fuzz targets call: each takes any bytes and must either read them or refuse them with an
// InputError.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace lilytank::fuzz {

struct Reader {
  const char* name;
  /// Whether the bytes could be read.
  bool (*read)(std::string_view bytes);
  /// A small file that the reader takes, to begin with.
  std::string seed;
};

/// One reader a format, and one each for compressed files and experiment files.
std::span<const Reader> readers();

}  // namespace lilytank::fuzz
