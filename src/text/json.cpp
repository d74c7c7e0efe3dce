#include "text/json.hpp"

#include <cmath>

#include "text/number.hpp"

namespace lilytank {

std::string json_quoted(const std::string& text) {
  constexpr char digits[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\', out += c;
    } else if (code < 0x20) {
      out += "\\u00", out += digits[code >> 4], out += digits[code & 15];
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string json_number(double value) {
  return std::isfinite(value) ? significant(value, 6) : "null";
}

}  // namespace lilytank
