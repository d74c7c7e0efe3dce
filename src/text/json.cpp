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

std::optional<double> json_number_of(const std::string& text, const std::string& key) {
  const std::string before = json_quoted(key) + ": ";
  const auto at = text.find(before);
  if (at == std::string::npos) return std::nullopt;
  const auto begin = at + before.size();
  return parse_number(
      std::string_view(text).substr(begin, text.find_first_of(",\n}", begin) - begin));
}

}  // namespace lilytank
