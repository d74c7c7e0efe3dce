#include "io/toml_fields.hpp"

#include <algorithm>
#include <cassert>

#include "io/scenario_values.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

std::vector<std::string> names_of(const TomlKeys& keys) {
  std::vector<std::string> out;
  for (const TomlKey& key : keys) out.push_back(key.name);
  return out;
}

}  // namespace

const TomlKey* find_key(const TomlKeys& keys, const std::string& name) {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const TomlKey& key) { return key.name == name; });
  return found == keys.end() ? nullptr : &*found;
}

TomlKeys nested(const TomlKeys& paths) {
  TomlKeys out;
  for (TomlKey key : paths) {
    TomlKeys* level = &out;
    for (auto dot = key.name.find('.'); dot != std::string::npos; dot = key.name.find('.')) {
      const std::string table = key.name.substr(0, dot);
      key.name.erase(0, dot + 1);
      if (find_key(*level, table) == nullptr) level->push_back(toml_key::table(table, {}, ""));
      const auto at = std::find_if(level->begin(), level->end(),
                                   [&](const TomlKey& one) { return one.name == table; });
      level = &at->keys;
    }
    level->push_back(std::move(key));
  }
  return out;
}

TomlFields::TomlFields(const toml::table& table, std::string path, std::string file,
                       const std::vector<std::string>& names)
    : table_(&table), path_(std::move(path)), file_(std::move(file)) {
  check_names(names);
}

TomlFields::TomlFields(const toml::table& table, std::string path, std::string file, TomlKeys keys)
    : TomlFields(table, std::move(path), std::move(file), names_of(keys)) {
  keys_ = std::move(keys);
}

const toml::node& TomlFields::value(const std::string& name) const {
  if (!has(name)) need(name, key(name).meaning);
  return *node(name);
}

const TomlKey& TomlFields::key(const std::string& name) const {
  const TomlKey* found = find_key(keys_, name);
  assert(found != nullptr);
  return *found;
}

// toml++ keeps keys sorted by name; the message should be about the first in the file.
void TomlFields::check_names(const std::vector<std::string>& names) const {
  const toml::key* first = nullptr;
  for (const auto& [key, node] : *table_) {
    if (std::find(names.begin(), names.end(), key.str()) != names.end()) continue;
    const bool earlier = first == nullptr || key.source().begin < first->source().begin;
    if (earlier) first = &key;
  }
  if (first == nullptr) return;
  const std::string name(first->str());
  std::string help = did_you_mean(name, names);
  if (help.empty() && !names.empty()) help = " - there are " + joined(names, ", ");
  throw InputError(place_of(first->source(), file_), "unknown key '" + path(name) + "'" + help);
}

SourcePlace TomlFields::place(const std::string& name) const {
  const toml::node* found = node(name);
  return found == nullptr ? place() : place_of(found->source(), file_);
}

std::string TomlFields::path(const std::string& name) const {
  return path_.empty() ? name : path_ + "." + name;
}

Assignment TomlFields::assignment(const std::string& name) const {
  return {{name}, {place(name)}, value_of(value(name)), place(name), "", ""};
}

std::string TomlFields::text(const std::string& name) const {
  std::string text = text_of(assignment(name), path(name));
  if (text.empty()) refuse(name, path(name) + " is empty");
  return text;
}

std::int64_t TomlFields::whole(const std::string& name, std::int64_t low, std::int64_t high) const {
  const toml::node& value = this->value(name);
  if (!value.is_integer()) {
    refuse(name, path(name) + " is a whole number, not " + kind_of(value_of(value)));
  }
  const std::int64_t number = value.as_integer()->get();
  if (number >= low && number <= high) return number;
  refuse(name, path(name) + " = " + std::to_string(number) + " is outside " + std::to_string(low) +
                   " .. " + std::to_string(high));
}

bool TomlFields::flag(const std::string& name) const {
  const toml::node& value = this->value(name);
  if (!value.is_boolean()) {
    refuse(name, path(name) + " is true or false, not " + kind_of(value_of(value)));
  }
  return value.as_boolean()->get();
}

double TomlFields::number(const std::string& name, const std::string& unit) const {
  return number_of(assignment(name), path(name), unit);
}

std::int64_t TomlFields::whole(const std::string& name) const {
  const TomlKey& one = key(name);
  return whole(name, static_cast<std::int64_t>(one.low), static_cast<std::int64_t>(one.high));
}

double TomlFields::number(const std::string& name) const {
  const TomlKey& one = key(name);
  const double value = number(name, one.unit);
  if (value >= one.low && value <= one.high) return value;
  const std::string unit = one.unit == "1" ? "" : " " + one.unit;
  refuse(name, path(name) + " = " + shortest(value) + unit + " is outside " + shortest(one.low) +
                   " .. " + shortest(one.high) + unit);
}

std::size_t TomlFields::word(const std::string& name) const {
  return index_of_word(assignment(name), path(name), key(name).words);
}

const toml::table& TomlFields::table(const std::string& name) const {
  const toml::table* found = node(name)->as_table();
  if (found == nullptr) refuse(name, name + " is a table, under the line [" + name + "]");
  return *found;
}

std::vector<std::pair<std::string, SourcePlace>> TomlFields::texts(const std::string& name) const {
  std::vector<std::pair<std::string, SourcePlace>> out;
  const auto one = [&](const toml::node& value) {
    const auto* text = value.as_string();
    const SourcePlace where = place_of(value.source(), file_);
    if (text == nullptr || text->get().empty()) {
      throw InputError(where, path(name) + " is text in quotes, or a list of texts");
    }
    out.emplace_back(text->get(), where);
  };
  if (const toml::array* list = value(name).as_array()) {
    for (const toml::node& item : *list) one(item);
    if (out.empty()) refuse(name, path(name) + " is empty");
  } else {
    one(value(name));
  }
  return out;
}

std::vector<const toml::table*> TomlFields::tables(const std::string& name) const {
  std::vector<const toml::table*> out;
  if (!has(name)) return out;
  const toml::array* list = node(name)->as_array();
  const auto is_table = [](const toml::node& item) { return item.is_table(); };
  if (list == nullptr || !std::all_of(list->begin(), list->end(), is_table)) {
    refuse(name, path(name) + " is a list of tables, each under its own line [[" + name + "]]");
  }
  for (const toml::node& item : *list) out.push_back(item.as_table());
  return out;
}

TomlFields TomlFields::fields(const std::string& name) const {
  return {table(name), path(name), file_, key(name).keys};
}

std::vector<TomlFields> TomlFields::list_of_fields(const std::string& name) const {
  std::vector<TomlFields> out;
  for (const toml::table* one : tables(name)) {
    out.emplace_back(*one, path(name), file_, key(name).keys);
  }
  return out;
}

void TomlFields::refuse(const std::string& name, const std::string& message) const {
  throw InputError(place(name), message);
}

void TomlFields::need(const std::string& name, const std::string& why) const {
  if (!has(name)) throw InputError(place(), path(name) + " is missing: " + why);
}

}  // namespace lilytank
