#include "statistics/text_table.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace lilytank {
namespace {

// Characters of UTF-8 text: bytes that do not go on with one.
std::size_t length_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

bool is_number(const std::string& cell) {
  return !cell.empty() &&
         (std::isdigit(static_cast<unsigned char>(cell.back())) || cell == "-" || cell == "inf" ||
          cell == "-inf") &&
         cell.find_first_not_of("+-.0123456789einf") == std::string::npos;
}

std::string with_precision(double value, std::chars_format format, int precision) {
  char buffer[400];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, format, precision).ptr};
}

}  // namespace

std::string TextTable::text() const {
  const std::size_t columns = rows_[0].size();
  std::vector<std::size_t> width(columns, 0);
  std::vector<bool> right(columns, rows_.size() > 1);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      width[c] = std::max(width[c], length_of(rows_[r][c]));
      if (r > 0 && !is_number(rows_[r][c])) right[c] = false;
    }
  }
  std::string out;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t c = 0; c < columns; ++c) {
      const std::string blanks(width[c] - length_of(row[c]), ' ');
      line += "  " + (right[c] ? blanks + row[c] : row[c] + blanks);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string fixed(double value, int decimals) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text = with_precision(value, std::chars_format::fixed, decimals);
  if (text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string with_interval(const Estimate& estimate, double unit, int most_decimals) {
  const double value = estimate.value / unit, low = estimate.low / unit;
  const double high = estimate.high / unit;
  const double half = (high - low) / 2;
  const bool scaled = std::isfinite(half) && half > 0;
  const double size = scaled ? half / 10 : std::fabs(value) / 100;
  int decimals = std::min(2, most_decimals);
  if (std::isfinite(size) && size > 0) {
    decimals = std::clamp(static_cast<int>(-std::floor(std::log10(size) + 1e-9)), 0, most_decimals);
  }
  const std::string text = fixed(value, decimals);
  if (std::isinf(low) && std::isinf(high)) return text;
  return text + " [" + fixed(low, decimals) + ", " + fixed(high, decimals) + "]";
}

std::string p_text(double p) {
  if (std::isnan(p)) return "-";
  return with_precision(p, std::chars_format::general, 2);
}

TimeScale time_scale(double length) {
  if (length > 3 * 3600) return {3600, "h"};
  if (length > 180) return {60, "min"};
  return {1, "s"};
}

}  // namespace lilytank
