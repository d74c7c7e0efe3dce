// One TOML table read strictly: unknown keys, kinds, units and bounds. Only for src/io.
#pragma once
#include <string>
#include <vector>

#include "io/toml_key.hpp"
#include "io/toml_text.hpp"

namespace lilytank {

class TomlFields {
 public:
  /// `path` names the table in messages ("study"; "" at the top), `names` are the keys that it may
  /// have. Throws InputError on another key. The table must outlive this.
  TomlFields(const toml::table& table, std::string path, std::string file,
             const std::vector<std::string>& names);
  /// The same for described keys. To read one that is needed and missing throws InputError.
  TomlFields(const toml::table& table, std::string path, std::string file, TomlKeys keys);

  bool has(const std::string& name) const { return table_->contains(name); }
  const toml::node* node(const std::string& name) const { return table_->get(name); }
  /// Of the value, or of the table where there is none.
  SourcePlace place(const std::string& name) const;
  SourcePlace place() const { return place_of(table_->source(), file_); }
  /// "study.seed".
  std::string path(const std::string& name) const;

  /// Values of keys that are there; throw InputError on another kind or out of bounds.
  std::string text(const std::string& name) const;
  std::int64_t whole(const std::string& name, std::int64_t low, std::int64_t high) const;
  bool flag(const std::string& name) const;
  double number(const std::string& name, const std::string& unit) const;
  /// The same within the bounds, in the unit and among the words of described keys.
  std::int64_t whole(const std::string& name) const;
  double number(const std::string& name) const;
  /// Which of the key's words.
  std::size_t word(const std::string& name) const;
  /// One text or a list of them, at least one, each with its place.
  std::vector<std::pair<std::string, SourcePlace>> texts(const std::string& name) const;
  /// The table under [name], which is there.
  const toml::table& table(const std::string& name) const;
  /// The tables under [[name]]; none if the key is not there.
  std::vector<const toml::table*> tables(const std::string& name) const;
  /// The same with the described keys of their tables.
  TomlFields fields(const std::string& name) const;
  std::vector<TomlFields> list_of_fields(const std::string& name) const;

  [[noreturn]] void refuse(const std::string& name, const std::string& message) const;
  /// For a key that must be there: "study.seed is missing: " + why.
  void need(const std::string& name, const std::string& why) const;

 private:
  void check_names(const std::vector<std::string>& names) const;
  Assignment assignment(const std::string& name) const;
  const TomlKey& key(const std::string& name) const;
  const toml::node& value(const std::string& name) const;
  const toml::table* table_;
  std::string path_, file_;
  TomlKeys keys_;
};

}  // namespace lilytank
