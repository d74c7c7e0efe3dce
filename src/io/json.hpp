// JSON as this program's files hold it.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace lilytank {

using Json = nlohmann::ordered_json;  // keys stay in the order in which they are written

/// A file's content: indented, null where a number is not finite. Bytes that are not UTF-8 become
/// U+FFFD.
inline std::string json_text(const Json& value) {
  return value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// The number at the top level under a key; nothing if the text is no JSON object or holds none.
inline std::optional<double> json_number_of(const std::string& text, const std::string& key) {
  const Json all = Json::parse(text, nullptr, false);
  if (!all.is_object() || !all.contains(key) || !all[key].is_number()) return std::nullopt;
  return all[key].get<double>();
}

}  // namespace lilytank
