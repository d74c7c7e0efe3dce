#include "statistics/csv_cells.hpp"

#include <charconv>
#include <cmath>

namespace lilytank {

std::string cell(double value) {
  if (!std::isfinite(value)) return "";
  if (value == 0) value = 0;  // no -0
  char buffer[40];
  const auto format = std::chars_format::general;
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, format, 10).ptr};
}

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string cells(const Estimate& e) {
  return cell(e.value) + "," + cell(e.low) + "," + cell(e.high);
}

}  // namespace lilytank
