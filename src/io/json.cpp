#include "io/json.hpp"

namespace lilytank {

std::string json_text(const Json& value) {
  return value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<double> json_number_of(const std::string& text, const std::string& key) {
  const Json all = Json::parse(text, nullptr, false);
  if (!all.is_object() || !all.contains(key) || !all[key].is_number()) return std::nullopt;
  return all[key].get<double>();
}

}  // namespace lilytank
