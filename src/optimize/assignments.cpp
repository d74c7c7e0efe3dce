#include "optimize/assignments.hpp"

namespace lilytank {

bool is_rule(const Assignment& path) {
  return path.keys.size() == 3 && path.keys.front() == "rules" && path.keys.back() == "p";
}

Assignment named(const std::vector<std::string>& keys, TomlValue value) {
  return {keys, std::vector<SourcePlace>(keys.size()), std::move(value), {}, "", ""};
}

SourcePlace place_in(const std::string& file, const std::vector<std::string>& paths) {
  const Layer layer = read_layers({file}, {}).front();
  for (const std::string& path : paths) {
    for (const Assignment& value : layer.values) {
      if (value.path() == path) return value.place;
    }
  }
  return {file, 0, 0};
}

}  // namespace lilytank
