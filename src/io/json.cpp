#include "io/json.hpp"

namespace lilytank {

std::string json_text(const Json& value) {
  return value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string json_line(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json json_of(const std::string& text) {
  return Json::parse(text);
}

Json json_or_discarded(const std::string& text) {
  return Json::parse(text, nullptr, false);
}

std::optional<double> json_number_of(const std::string& text, const std::string& key) {
  const Json all = json_or_discarded(text);
  if (!all.is_object() || !all.contains(key) || !all[key].is_number()) return std::nullopt;
  return all[key].get<double>();
}

}  // namespace lilytank
