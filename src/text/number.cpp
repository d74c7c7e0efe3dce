#include "text/number.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace lilytank {
namespace {

template <class T>
std::string shortest_of(T value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

template <class T>
std::optional<T> parse(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  T value{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

template <class T>
std::optional<T> finite(std::optional<T> value) {
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

std::string shortest(double value) {
  return shortest_of(value);
}
std::string shortest(float value) {
  return shortest_of(value);
}

std::string without_rounding(double value) {
  char buffer[40];
  const auto format = std::chars_format::general;
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, format, 15).ptr};
}

std::string significant(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::optional<double> parse_number(std::string_view text) {
  return finite(parse<double>(text));
}
std::optional<float> parse_float(std::string_view text) {
  return finite(parse<float>(text));
}
std::optional<std::int64_t> parse_whole(std::string_view text) {
  return parse<std::int64_t>(text);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace lilytank
