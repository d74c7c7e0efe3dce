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

/// The key nearest to a whole path: " - did you mean 'module.count'?".
std::string nearest_path(const Assignment& from, const std::vector<ScenarioKey>& keys) {
  std::vector<std::string> paths;
  for (const ScenarioKey& key : keys) paths.push_back(key.path);
  return did_you_mean(from.path(), paths);
}

/// Whether a path is that of a file's own lines: only there are tables that are no keys' tables.
/// (Those of --set and of axes are named in one piece.)
bool is_in_file(const Assignment& from) {
  const SourcePlace& key = from.key_places.front();
  return key.line != from.place.line || key.column != from.place.column;
}

/// What a file is that has a table of this name and is no scenario, and the verb that takes it.
std::string other_file(const std::string& table) {
  if (table == "study" || table == "axis") return "the file of a study: for lilytank study";
  if (table == "optimize" || table == "parameter")
    return "the file of an optimisation: for lilytank optimize";
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
    std::vector<std::string> names = names_after(prefix, keys);
    if (i == 0 && is_in_file(from)) {
      if (const std::string what = other_file(name); !what.empty()) {
        return {from.key_places[i], "[" + name + "] is not of a scenario, but of " + what};
      }
      names.insert(names.end(), {"base", "command", "experiment", "recording"});
    }
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      std::string help = did_you_mean(name, names);
      // A path in one piece is mended as one.
      if (i == 0 && !help.empty() && from.keys.size() > 1 && !is_in_file(from)) {
        if (const std::string whole = nearest_path(from, keys); !whole.empty()) help = whole;
      }
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
