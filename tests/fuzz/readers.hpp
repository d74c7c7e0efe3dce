// What the fuzz targets call: each takes any bytes and must either read them or refuse them with an
// InputError of one line that names the file.
#pragma once
#include <cstdlib>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lilytank::fuzz {

struct Reader {
  const char* name;
  /// Whether the bytes could be read.
  bool (*read)(std::string_view bytes);
  /// A small file that the reader takes, to begin with.
  std::string seed;
};

/// All readers: one a recording format, one a text or binary format of the product's own.
std::span<const Reader> readers();
std::vector<Reader> recording_readers();
std::vector<Reader> file_readers();
std::vector<Reader> search_readers();

/// A promise of a reader; where it is broken, the program ends and the input is kept.
void demand(bool right, const std::string& promise);
/// A directory of this process, removed when it ends.
const std::string& scratch();
/// Writes a file into scratch(); returns its path.
std::string write_scratch(const std::string& name, std::string_view bytes);
/// The content of a file in scratch().
std::string stored(const std::string& name);
/// The message of the last refusal.
std::string& last_refusal();
/// Whether `work` ends without InputError; its message must be one line that holds `named`.
bool accepts(const std::string& named, const std::function<void()>& work);

}  // namespace lilytank::fuzz
