#include "io/scenario_values.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/units.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

/// " m", or nothing for numbers without a unit.
std::string after(const std::string& unit) {
  return unit.empty() || unit == "1" ? "" : " " + unit;
}

/// The value as the user wrote it: a quantity in quotes with its SI value, or a plain number.
std::string as_written(const Assignment& from, double value, const std::string& unit) {
  const auto* text = std::get_if<std::string>(&from.value);
  const std::string plain = shortest(value) + after(unit);
  return text == nullptr || *text == plain ? plain : *text + " (" + plain + ")";
}

/// What a value out of bounds may have been meant as.
std::string meant(const Assignment& from, const ScenarioKey& key, double value) {
  if (key.path.ends_with(".sigma_stoch")) {
    const double tabled = value / 1e4;
    if (tabled >= key.low && tabled <= key.high) {
      return " - the paper's table is in 1e-4 N: write " + without_rounding(tabled) + ", in N";
    }
  }
  const bool plain = !std::holds_alternative<std::string>(from.value);
  const bool counted = key.whole || !std::holds_alternative<double*>(key.target);  // no shares
  return plain && !counted ? unit_hint(value, key.unit, key.low, key.high) : "";
}

void check_bounds(const ScenarioKey& key, const Assignment& from, double value) {
  if (value >= key.low && value <= key.high) return;
  throw InputError(from.place, key.path + " = " + as_written(from, value, key.unit) +
                                   " is outside " + bounds_text(key) + after(key.unit) +
                                   meant(from, key, value));
}

InputError wrong_kind(const Assignment& from, const std::string& path, const std::string& right) {
  return {from.place, path + " is " + right + ", not " + kind_of(from.value)};
}

std::int64_t whole_of(const ScenarioKey& key, const Assignment& from) {
  if (const auto* v = std::get_if<std::int64_t>(&from.value)) return *v;
  if (const auto* v = std::get_if<double>(&from.value)) {
    throw InputError(from.place, key.path + " is a whole number; " + shortest(*v) + " is not");
  }
  throw wrong_kind(from, key.path, "a whole number");
}

double checked_number(const ScenarioKey& key, const Assignment& from) {
  const double value =
      key.whole ? static_cast<double>(whole_of(key, from)) : number_of(from, key.path, key.unit);
  check_bounds(key, from, value);
  return value;
}

std::int64_t checked_whole(const ScenarioKey& key, const Assignment& from) {
  const std::int64_t value = whole_of(key, from);
  check_bounds(key, from, static_cast<double>(value));
  return value;
}

bool switch_of(const ScenarioKey& key, const Assignment& from) {
  if (const auto* v = std::get_if<bool>(&from.value)) return *v;
  throw wrong_kind(from, key.path, "a switch, true or false");
}

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

}  // namespace

std::string text_of(const Assignment& from, const std::string& path) {
  if (const auto* v = std::get_if<std::string>(&from.value)) return *v;
  const bool scalar = std::holds_alternative<bool>(from.value) ||
                      std::holds_alternative<std::int64_t>(from.value) ||
                      std::holds_alternative<double>(from.value);
  if (scalar && !from.raw.empty()) return from.raw;  // --set title=7
  throw wrong_kind(from, path, "text in quotes");
}

std::size_t index_of_word(const Assignment& from, const std::string& path,
                          const std::vector<std::string>& words) {
  const std::string word = text_of(from, path);
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) throw unknown_word(from.place, path, word, words);
  return static_cast<std::size_t>(found - words.begin());
}

double number_of(const Assignment& from, const std::string& path, const std::string& unit) {
  if (const auto* v = std::get_if<std::int64_t>(&from.value)) return static_cast<double>(*v);
  if (const auto* v = std::get_if<std::string>(&from.value)) {
    return read_quantity(*v, unit, path, from.place);
  }
  const auto* v = std::get_if<double>(&from.value);
  if (v == nullptr) throw wrong_kind(from, path, described(unit));
  if (!std::isfinite(*v)) {
    throw InputError(from.place, path + " = " + shortest(*v) + " is not a finite number");
  }
  return *v;
}

void assign(const ScenarioKey& key, const Assignment& from) {
  const auto store = Overloaded{
      [&](double* to) { *to = checked_number(key, from); },
      [&](int* to) { *to = static_cast<int>(checked_whole(key, from)); },
      [&](std::uint64_t* to) { *to = static_cast<std::uint64_t>(checked_whole(key, from)); },
      [&](bool* to) { *to = switch_of(key, from); },
      [&](std::string* to) { *to = text_of(from, key.path); },
      [&](const WordChoice& to) { to.set(index_of_word(from, key.path, to.words)); },
      [&](const FileName& to) {
        const std::string name = text_of(from, key.path);
        *to.name = name.empty() ? "" : (std::filesystem::path(from.directory) / name).string();
      },
  };
  std::visit(store, key.target);
}

std::string value_text(const ScenarioKey& key) {
  const auto text = Overloaded{
      [](const double* v) { return shortest(*v); },
      [](const int* v) { return std::to_string(*v); },
      [](const std::uint64_t* v) { return std::to_string(*v); },
      [](const bool* v) { return std::string(*v ? "true" : "false"); },
      [](const std::string* v) { return toml_quoted(*v); },
      [](const WordChoice& v) { return toml_quoted(v.words[v.get()]); },
      [](const FileName& v) { return toml_quoted(*v.name); },
  };
  return std::visit(text, key.target);
}

std::string bounds_text(const ScenarioKey& key) {
  if (const auto* choice = std::get_if<WordChoice>(&key.target)) {
    return joined(choice->words, " | ");
  }
  if (std::holds_alternative<bool*>(key.target)) return "true | false";
  if (key.low == key.high) return "";
  return shortest(key.low) + " .. " + shortest(key.high);
}

std::string toml_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\', out += c;
    } else if (code < 0x20 || code == 0x7f) {
      constexpr char digits[] = "0123456789abcdef";
      out += "\\u00", out += digits[code >> 4], out += digits[code & 15];
    } else {
      out += c;
    }
  }
  return out + '"';
}

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
        help = " - '" + prefix.substr(0, prefix.size() - 1) + "' has " + joined(names, ", ");
      }
      return {from.key_places[i], "unknown key '" + from.path() + "'" + help};
    }
    prefix = here + ".";
  }
  const std::string table = prefix.substr(0, prefix.size() - 1);
  return {from.place, "'" + table + "' is a table with " + joined(names_after(prefix, keys), ", ")};
}

InputError unknown_word(const SourcePlace& place, const std::string& path, const std::string& word,
                        const std::vector<std::string>& words) {
  return {place, path + " = \"" + word + "\" is none of " + joined(words, ", ") +
                     did_you_mean(word, words)};
}

}  // namespace lilytank
