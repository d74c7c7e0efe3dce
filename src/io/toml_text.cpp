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

}  // namespace

SourcePlace place_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

toml::table parse_toml(const std::string& text, const std::string& file) {
  try {
    return toml::parse(std::string_view(text), std::string_view(file));
  } catch (const toml::parse_error& e) {
    throw InputError(place_of(e.source(), file), std::string(e.description()));
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
