// What the keys of a TOML table may hold: one list for reading a file and for its JSON Schema.
#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace lilytank {

/// A key, the kind and the bounds of its value.
struct TomlKey {
  enum class Kind : std::uint8_t {
    text,
    texts,     ///< one text or a list of them
    flag,      ///< true or false
    on_off,    ///< the same, or "on" and "off"
    whole,     ///< an integer
    number,    ///< in `unit`, or a text with a unit
    quantity,  ///< the same where the unit depends on another key
    word,      ///< one of `words` that are not empty
    list,      ///< of values of any kind
    numbers,   ///< a list of numbers
    table,     ///< with `keys`
    tables,    ///< a list of them, each with `keys`
    by_name,   ///< a table of tables with any names, each with `keys`
    figures,   ///< numbers or texts with units: one, a list, or a table of them
  };
  std::string name;
  Kind kind = Kind::text;
  std::string meaning;  ///< one sentence
  std::string unit = "";
  double low = -INFINITY, high = INFINITY;  ///< inclusive, of numbers
  std::vector<std::string> words = {};
  std::vector<TomlKey> keys = {};
  bool needed = false;
  std::string standard = "";  ///< the default as TOML; empty: none, or as `meaning` says
};

using TomlKeys = std::vector<TomlKey>;

namespace toml_key {

inline TomlKey text(std::string name, std::string meaning) {
  return {std::move(name), TomlKey::Kind::text, std::move(meaning)};
}
inline TomlKey texts(std::string name, std::string meaning) {
  return {std::move(name), TomlKey::Kind::texts, std::move(meaning)};
}
inline TomlKey flag(std::string name, std::string meaning) {
  return {std::move(name), TomlKey::Kind::flag, std::move(meaning)};
}
inline TomlKey on_off(std::string name, std::string meaning) {
  return {std::move(name), TomlKey::Kind::on_off, std::move(meaning)};
}
inline TomlKey whole(std::string name, std::int64_t low, std::int64_t high, std::string meaning) {
  return {std::move(name),          TomlKey::Kind::whole,     std::move(meaning), "1",
          static_cast<double>(low), static_cast<double>(high)};
}
inline TomlKey number(std::string name, std::string unit, double low, double high,
                      std::string meaning) {
  return {std::move(name), TomlKey::Kind::number, std::move(meaning), std::move(unit), low, high};
}
inline TomlKey quantity(std::string name, std::string meaning) {
  return {std::move(name), TomlKey::Kind::quantity, std::move(meaning)};
}
inline TomlKey word(std::string name, std::vector<std::string> words, std::string meaning) {
  TomlKey out{std::move(name), TomlKey::Kind::word, std::move(meaning)};
  out.words = std::move(words);
  return out;
}
inline TomlKey list(std::string name, std::string meaning) {
  return {std::move(name), TomlKey::Kind::list, std::move(meaning)};
}
inline TomlKey numbers(std::string name, std::string meaning) {
  return {std::move(name), TomlKey::Kind::numbers, std::move(meaning)};
}
inline TomlKey figures(std::string name, std::string meaning) {
  return {std::move(name), TomlKey::Kind::figures, std::move(meaning)};
}
inline TomlKey table(std::string name, TomlKeys keys, std::string meaning) {
  TomlKey out{std::move(name), TomlKey::Kind::table, std::move(meaning)};
  out.keys = std::move(keys);
  return out;
}
inline TomlKey tables(std::string name, TomlKeys keys, std::string meaning) {
  TomlKey out{std::move(name), TomlKey::Kind::tables, std::move(meaning)};
  out.keys = std::move(keys);
  return out;
}
inline TomlKey by_name(std::string name, TomlKeys keys, std::string meaning) {
  TomlKey out{std::move(name), TomlKey::Kind::by_name, std::move(meaning)};
  out.keys = std::move(keys);
  return out;
}
/// A key without which the file is refused.
inline TomlKey needed(TomlKey key) {
  key.needed = true;
  return key;
}

}  // namespace toml_key

/// The key of that name, or null.
const TomlKey* find_key(const TomlKeys& keys, const std::string& name);
/// Keys named by paths ("tank.radius") as tables of keys, in the order of their first ones.
TomlKeys nested(const TomlKeys& paths);

}  // namespace lilytank
