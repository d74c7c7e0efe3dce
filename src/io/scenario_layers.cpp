#include "io/scenario_layers.hpp"

#include <algorithm>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_resolve.hpp"
#include "io/toml_text.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

/// Tables that are not keys of a scenario's table.
bool stands_apart(std::string_view name) {
  return name == "base" || name == "command" || name == "experiment" || name == "recording";
}

/// Turns tables into assignments.
class Flattener {
 public:
  Flattener(std::string file, std::string directory)
      : file_(std::move(file)), directory_(std::move(directory)) {}

  Layer layer(const toml::table& root) {
    Layer out;
    top_ = &root;
    table(root, {}, {}, out.values);
    if (const toml::node* node = root.get("command")) {
      out.has_commands = true;
      out.commands = list(*node, "command");
    }
    if (const toml::node* node = root.get("recording")) {
      out.has_recordings = true;
      out.recordings = list(*node, "recording");
    }
    if (const toml::node* node = root.get("experiment")) experiment(*node, out);
    return out;
  }

 private:
  void table(const toml::table& from, const std::vector<std::string>& keys,
             const std::vector<SourcePlace>& places, std::vector<Assignment>& out) {
    for (const auto& [key, node] : from) {
      if (top_ == &from && stands_apart(key.str())) continue;
      auto path = keys;
      auto path_places = places;
      path.emplace_back(key.str());
      path_places.push_back(place_of(key.source(), file_));
      const toml::table* inner = node.as_table();
      if (inner != nullptr && !inner->empty()) {
        table(*inner, path, path_places, out);
        continue;
      }
      const SourcePlace place = place_of(node.source(), file_);
      out.push_back({path, path_places, value_of(node), place, directory_, ""});
    }
    // toml++ keeps keys sorted by name; messages should come in the file's order.
    std::stable_sort(out.begin(), out.end(), [](const Assignment& a, const Assignment& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
  }

  std::vector<CommandTable> list(const toml::node& node, const std::string& name) {
    std::vector<CommandTable> out;
    const toml::array* items = node.as_array();
    if (items == nullptr || (!items->empty() && !items->is_homogeneous<toml::table>())) {
      throw InputError(place_of(node.source(), file_),
                       name + " is a list of tables, each under its own line [[" + name + "]]");
    }
    for (const toml::node& item : *items) {
      CommandTable entry{place_of(item.source(), file_), {}};
      table(*item.as_table(), {}, {}, entry.fields);
      out.push_back(std::move(entry));
    }
    return out;
  }

  void experiment(const toml::node& node, Layer& out) {
    const toml::table* found = node.as_table();
    if (found == nullptr) {
      throw InputError(place_of(node.source(), file_),
                       "experiment is a table, under the line [experiment]");
    }
    table(*found, {}, {}, out.experiment);
  }

  std::string file_, directory_;
  const toml::table* top_ = nullptr;
};

/// Reads a file and the files under it.
class FileReader {
 public:
  explicit FileReader(std::vector<Layer>& layers) : layers_(&layers) {}

  void read(const std::string& file, const SourcePlace& asked_by) {
    std::error_code ignored;
    const std::string identity = fs::weakly_canonical(file, ignored).string();
    if (std::find(open_.begin(), open_.end(), identity) != open_.end()) {
      throw InputError(asked_by, "base '" + file + "' leads back to itself");
    }
    const std::string text = read_whole(file, asked_by);
    if (text.starts_with(kResolvedFirst) && text.find(kResolvedLast) == std::string::npos) {
      throw InputError({file}, "the file is cut: its last line '# end' is missing");
    }
    const toml::table root = parse_toml(text, file);
    const std::string directory = fs::path(file).parent_path().string();
    open_.push_back(identity);
    if (const toml::node* base = root.get("base")) read_bases(*base, file, directory);
    open_.pop_back();
    layers_->push_back(Flattener(file, directory).layer(root));
  }

 private:
  void read_bases(const toml::node& base, const std::string& file, const std::string& directory) {
    const auto one = [&](const toml::node& node) {
      const SourcePlace place = place_of(node.source(), file);
      const auto* name = node.as_string();
      if (name == nullptr) throw InputError(place, "base is a file name or a list of file names");
      read((fs::path(directory) / name->get()).string(), place);
    };
    if (const toml::array* list = base.as_array()) {
      for (const toml::node& node : *list) one(node);
    } else {
      one(base);
    }
  }

  std::vector<Layer>* layers_;
  std::vector<std::string> open_;
};

/// Adds "path=value" to `out`: the value is TOML, or else taken as text.
void read_set(const std::string& option, const std::string& set, std::vector<Assignment>& out) {
  const SourcePlace place{option + " " + set, 0, 0};
  const auto equals = set.find('=');
  if (equals == std::string::npos || set.find('\n') != std::string::npos) {
    const std::string example = option == "--set" ? "tank.radius=0.3" : "rate=25";
    throw InputError(place, "write " + option + " path=value, as in " + option + " " + example);
  }
  const std::string path(trimmed(std::string_view(set).substr(0, equals)));
  const std::string raw(trimmed(std::string_view(set).substr(equals + 1)));
  for (const char quote : {'"', '\''}) {
    if (raw.starts_with(quote) && (raw.size() == 1 || !raw.ends_with(quote))) {
      throw InputError(place, "the quotation mark of " + raw + " is not closed");
    }
  }
  toml::table root;
  bool text = false;
  try {
    root = toml::parse(path + " = " + raw);
  } catch (const toml::parse_error&) {
    text = true;
  }
  try {
    if (text) root = toml::parse(path + " = 0");
  } catch (const toml::parse_error&) {
    throw InputError(place, "'" + path + "' is not a path such as tank.radius");
  }
  for (const auto& [key, node] : root) {
    if (stands_apart(key.str())) {
      throw InputError(place, "'" + path + "' can be given in files only");
    }
  }
  for (Assignment& value : Flattener(place.file, "").layer(root).values) {
    value.place = place;
    for (SourcePlace& key_place : value.key_places) key_place = place;
    value.raw = raw;
    if (text) value.value = raw;
    out.push_back(std::move(value));
  }
}

}  // namespace

std::string kind_of(const TomlValue& value) {
  if (std::holds_alternative<bool>(value)) return "a switch";
  if (std::holds_alternative<std::int64_t>(value)) return "a whole number";
  if (std::holds_alternative<double>(value)) return "a number";
  if (std::holds_alternative<std::string>(value)) return "text";
  if (std::holds_alternative<Numbers>(value)) return "a list";
  if (std::holds_alternative<EmptyTable>(value)) return "a table";
  if (std::holds_alternative<Reals>(value)) return "a list that is not of whole numbers";
  return std::get<Unusable>(value).kind;
}

std::string Assignment::path() const {
  return joined(keys, ".");
}

std::optional<std::uint64_t> take_seed(std::vector<std::string>& sets) {
  std::optional<std::uint64_t> seed;
  std::erase_if(sets, [&](const std::string& set) {
    if (trimmed(std::string_view(set).substr(0, set.find('='))) != "run.seed") return false;
    seed = load_scenario({}, {set}).seed;
    return true;
  });
  return seed;
}

std::vector<Layer> read_layers(const std::vector<std::string>& files,
                               const std::vector<std::string>& sets) {
  std::vector<Layer> layers;
  FileReader reader(layers);
  for (const std::string& file : files) reader.read(file, {});
  Layer overrides;
  overrides.values = read_assignments(sets, "--set");
  layers.push_back(std::move(overrides));
  return layers;
}

std::vector<Assignment> read_assignments(const std::vector<std::string>& texts,
                                         const std::string& option) {
  std::vector<Assignment> out;
  for (const std::string& text : texts) read_set(option, text, out);
  return out;
}

}  // namespace lilytank
