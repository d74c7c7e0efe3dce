#include "io/toml_text.hpp"

namespace lilytank {
namespace {

TomlValue list_of(const toml::array& array) {
  Numbers numbers;
  Reals reals;
  for (const toml::node& item : array) {
    const auto value = item.value<double>();
    if (!value || item.is_boolean()) return Unusable{"a list that is not of whole numbers"};
    reals.push_back(*value);
    if (const auto* whole = item.as_integer()) numbers.push_back(whole->get());
  }
  if (numbers.size() < reals.size()) return reals;
  return numbers;
}

/// Whether a place is the end of a line of ASCII characters.
bool ends_line(std::string_view text, const SourcePlace& place) {
  for (int line = 1; line < place.line; ++line) text.remove_prefix(text.find('\n') + 1);
  const auto at = static_cast<std::size_t>(place.column) - 1;
  return text.find_first_of("\r\n", 0) <= at || text.size() <= at;
}

}  // namespace

SourcePlace place_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

toml::table parse_toml(const std::string& text, const std::string& file) {
  try {
    return toml::parse(std::string_view(text), std::string_view(file));
  } catch (const toml::parse_error& e) {
    const SourcePlace place = place_of(e.source(), file);
    const std::string what(e.description());
    if (what.find("string: ") != what.npos && ends_line(text, place)) {
      throw InputError(place, "the quotation mark of this text is not closed");
    }
    throw InputError(place, what);
  }
}

TomlValue value_of(const toml::node& node) {
  if (const auto* v = node.as_boolean()) return v->get();
  if (const auto* v = node.as_integer()) return v->get();
  if (const auto* v = node.as_floating_point()) return v->get();
  if (const auto* v = node.as_string()) return v->get();
  if (const auto* v = node.as_array()) return list_of(*v);
  if (node.is_table()) return EmptyTable{};
  return Unusable{"a date or time"};
}

}  // namespace lilytank
