// Messages about names that are not in the table of keys.
#include <algorithm>

#include "io/scenario_values.hpp"

namespace lilytank {
namespace {

/// The names that may follow `prefix` ("" or "forces."), each once.
std::vector<std::string> names_after(const std::string& prefix,
                                     const std::vector<ScenarioKey>& keys) {
  std::vector<std::string> names;
  for (const ScenarioKey& key : keys) {
    if (!key.path.starts_with(prefix)) continue;
    const std::string rest = key.path.substr(prefix.size());
    std::string name = rest.substr(0, rest.find('.'));
    if (std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(std::move(name));
  }
  return names;
}

/// A key elsewhere whose last part is `name`: " - did you mean 'tank.radius'?".
std::string same_name_elsewhere(const std::string& name, const std::vector<ScenarioKey>& keys) {
  for (const ScenarioKey& key : keys) {
    if (key.path.ends_with("." + name)) return " - did you mean '" + key.path + "'?";
  }
  return "";
}

std::string listed(const std::vector<std::string>& words, const std::string& between) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

}  // namespace

InputError unknown_key(const Assignment& from, const std::vector<ScenarioKey>& keys) {
  std::string prefix;
  for (std::size_t i = 0; i < from.keys.size(); ++i) {
    const std::string& name = from.keys[i];
    const std::string here = prefix + name;
    const bool value = std::any_of(keys.begin(), keys.end(),
                                   [&](const ScenarioKey& key) { return key.path == here; });
    if (value && i + 1 < from.keys.size()) {
      return {from.key_places[i + 1],
              "'" + here + "' is a value and has no '" + from.keys[i + 1] + "'"};
    }
    const std::vector<std::string> names = names_after(prefix, keys);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      std::string help = did_you_mean(name, names);
      if (help.empty()) help = same_name_elsewhere(from.keys.back(), keys);
      if (help.empty() && !prefix.empty() && names.size() <= 12) {
        help = " - '" + prefix.substr(0, prefix.size() - 1) + "' has " + listed(names, ", ");
      }
      return {from.key_places[i], "unknown key '" + from.path() + "'" + help};
    }
    prefix = here + ".";
  }
  const std::string table = prefix.substr(0, prefix.size() - 1);
  return {from.place, "'" + table + "' is a table with " + listed(names_after(prefix, keys), ", ")};
}

InputError unknown_word(const SourcePlace& place, const std::string& path, const std::string& word,
                        const std::vector<std::string>& words) {
  return {place, path + " = \"" + word + "\" is none of " + listed(words, ", ") +
                     did_you_mean(word, words)};
}

}  // namespace lilytank
