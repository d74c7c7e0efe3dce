#include "text/printable.hpp"

#include <cstdint>
#include <cstdio>

namespace lilytank {
namespace {

struct Character {
  std::size_t bytes = 0;  ///< 0: not UTF-8
  std::uint32_t code = 0;
};

/// The character that a text begins with.
Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {1, lead};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return {};
  std::uint32_t code = lead & (0xffu >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  const bool longer_than_needed = (bytes == 3 && code < 0x800) || (bytes == 4 && code < 0x10000);
  if (surrogate || longer_than_needed || code > 0x10ffff) return {};
  return {bytes, code};
}

bool shows(const Character& c) {
  if (c.bytes == 0 || c.code < 0x20 || (c.code >= 0x7f && c.code < 0xa0)) return false;
  const bool line_end = c.code == 0x2028 || c.code == 0x2029;
  const bool direction = c.code == 0x200e || c.code == 0x200f ||
                         (c.code >= 0x202a && c.code <= 0x202e) ||
                         (c.code >= 0x2066 && c.code <= 0x2069);
  return !line_end && !direction;
}

void append_escaped(std::string& out, unsigned char byte) {
  char text[8];
  switch (byte) {
    case '\n':
      out += "\\n";
      break;
    case '\r':
      out += "\\r";
      break;
    case '\t':
      out += "\\t";
      break;
    default:
      std::snprintf(text, sizeof text, "\\x%02x", byte);
      out += text;
  }
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Character c = first_character(text);
    const std::size_t bytes = c.bytes == 0 ? 1 : c.bytes;
    if (shows(c)) {
      out.append(text.substr(0, bytes));
    } else {
      for (const char b : text.substr(0, bytes)) append_escaped(out, static_cast<unsigned char>(b));
    }
    text.remove_prefix(bytes);
  }
  return out;
}

}  // namespace lilytank
