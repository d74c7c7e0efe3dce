// How the bytes of a file are text.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace lilytank {

enum class TextEncoding : std::uint8_t { utf8, utf16_little, utf16_big };

/// By a byte order mark, or for UTF-16 without one by the zero byte of every ASCII character.
TextEncoding encoding_of(std::string_view begin);

/// What a file that is no text is, by its first bytes: "a picture (PNG)"; "" if it may be text.
std::string binary_kind(std::string_view begin);

/// UTF-16 as UTF-8, in pieces of any size. Halves of surrogate pairs become U+FFFD.
class Utf16Decoder {
 public:
  explicit Utf16Decoder(bool big) : big_(big) {}
  /// Adds the text of some bytes to `out`; `last`: there are no more.
  void decode(std::string_view bytes, bool last, std::string& out);

 private:
  void unit(std::uint16_t unit, std::string& out);
  bool big_;
  int half_ = -1;           ///< the first byte of a unit, -1: there is none
  std::uint16_t high_ = 0;  ///< the first half of a surrogate pair, 0: there is none
};

}  // namespace lilytank
