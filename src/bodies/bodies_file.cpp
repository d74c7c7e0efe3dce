#include "bodies/bodies_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "io/atomic_file.hpp"
#include "io/scenario_values.hpp"
#include "io/standard_input.hpp"
#include "io/toml_fields.hpp"
#include "io/units.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLines = 1'000'000'000;

TomlKeys experiment_keys() {
  using namespace toml_key;
  return {
      text("name", "name of the experiment, used for the output folder"),
      word("body", {"point"}, "what moves"),
      whole("dimensions", 1, 2, "coordinates of a body"),
      text("unit", "of positions: m or rad"),
      word("coordinates", {"plane", "geographic"},
           "geographic: x is a longitude and y a latitude, in degrees"),
      quantity("noise", "standard error of a position; without it, it is estimated"),
      word("coefficients", {"shared", "each body", "each run"}, "what the coefficients belong to"),
      quantity("density", "of the medium, kg/m^3: drag coefficients Cd are then reported"),
      quantity("turning", "rate at which the frame turns, 1/s, counter-clockwise"),
      text("latitude", "driver with the latitude in degrees"),
      texts("current", "drivers with the velocity of the medium, m/s, one a dimension"),
      texts("wind", "drivers with the velocity of the wind, m/s, one a dimension")};
}

TomlKeys baseline_keys(const std::vector<std::string>& laws) {
  TomlKeys out;
  for (const std::string& law : laws)
    out.push_back(toml_key::quantity(law, "coefficient of the law, or \"fit\""));
  out.push_back(toml_key::quantity("contact", "restitution of contacts, 0 to 1"));
  return out;
}

TomlKeys recording_keys_of_points() {
  using namespace toml_key;
  return {needed(text("file", "table of positions")),
          needed(text("time", "column of times")),
          quantity("time_unit", "s per unit of times"),
          whole("header_line", 0, kMostLines, "line of the names; 0: there are none"),
          whole("first_row", 1, kMostLines, "line of the first row"),
          flag("decimal_comma", "0,5 is a half"),
          text("body", "column of bodies' names"),
          text("run", "column of runs' names"),
          needed(texts("x", "column of positions, or one a body")),
          texts("y", "the same of the second coordinate"),
          figures("mass", "kg: of all bodies, of each, or by name"),
          figures("radius", "m: likewise"),
          texts("drivers", "columns that may drive a force"),
          quantity("scale", "m (or rad) for 1 in the columns of positions"),
          whole("every", 1, 1000000, "one row in so many is used"),
          flag("together", "bodies act on each other"),
          flag("held_out", "for testing only")};
}

class Reader {
 public:
  Reader(const std::string& file, const std::vector<std::string>& laws)
      : file_(file), laws_(laws), root_(parse_toml(read_whole(file), file)) {}

  BodyFile read() {
    const TomlFields top(root_, "", file_, {"experiment", "baseline", "recording"});
    if (!top.has("experiment")) throw InputError({file_, 1, 1}, "there is no [experiment] table");
    experiment(top.table("experiment"));
    if (top.has("baseline")) baseline(top.table("baseline"));
    for (const toml::table* one : top.tables("recording")) recording(*one);
    if (out_.tables.empty()) {
      throw InputError({file_, 1, 1}, "there is no [[recording]]: nothing to diagnose");
    }
    return std::move(out_);
  }

 private:
  static std::vector<std::string> names_of(const TomlKeys& keys) {
    std::vector<std::string> out;
    for (const TomlKey& key : keys) out.push_back(key.name);
    return out;
  }

  // A number of at least `low`, given plainly or with a unit.
  double number(const TomlFields& f, const std::string& name, const std::string& unit,
                double low) const {
    const double value = f.number(name, unit);
    if (value < low || value > 1e12) {
      f.refuse(name, f.path(name) + " = " + shortest(value) + " is outside " + shortest(low) +
                         " .. 1e+12 " + unit);
    }
    return value;
  }

  void experiment(const toml::table& from) {
    const TomlFields f(from, "experiment", file_, names_of(experiment_keys()));
    BodyExperiment& e = out_.experiment;
    e.name = f.has("name") ? f.text("name") : stem_of(file_);
    const std::string unsafe = "/\\\n";
    if (e.name.empty() || e.name.find_first_of(unsafe) != std::string::npos) {
      f.refuse("name",
               "experiment.name is empty or has a character that names of files cannot have");
    }
    if (f.has("dimensions")) e.dimensions = static_cast<int>(f.whole("dimensions", 1, 2));
    if (f.has("unit")) {
      e.unit = f.text("unit");
      const auto unit = parse_unit(e.unit);
      if (!unit || unit->ten != 0 || unit->scale != 1) {
        f.refuse("unit", "experiment.unit = \"" + e.unit + "\" is not m or rad");
      }
    }
    if (f.has("noise")) {
      e.noise = number(f, "noise", e.unit, 0);
      if (!(e.noise > 0)) {
        f.refuse("noise", "experiment.noise is more than 0; leave it out if it is to be estimated");
      }
    }
    if (f.has("coefficients")) {
      const std::string word = f.text("coefficients");
      const std::vector<std::string> words{"shared", "each body", "each run"};
      const auto found = std::find(words.begin(), words.end(), word);
      if (found == words.end())
        throw unknown_word(f.place("coefficients"), "experiment.coefficients", word, words);
      e.coefficients = static_cast<Coefficients>(found - words.begin());
    }
    if (f.has("coordinates")) {
      const std::string word = f.text("coordinates");
      e.geographic = word == "geographic";
      if (!e.geographic && word != "plane") {
        throw unknown_word(f.place("coordinates"), "experiment.coordinates", word,
                           {"plane", "geographic"});
      }
      if (e.geographic && (e.dimensions != 2 || e.unit != "m")) {
        f.refuse("coordinates", "geographic coordinates need experiment.dimensions = 2 and unit m");
      }
    }
    if (f.has("density")) {
      e.density = number(f, "density", "kg/m^3", 0);
      if (e.unit != "m") f.refuse("density", "experiment.density needs positions in m");
    }
    if (f.has("turning")) e.turning = f.number("turning", "1/s");
    if (f.has("latitude")) out_.latitude = {f.text("latitude"), f.place("latitude")};
    for (const auto& [key, to] : {std::pair("current", &out_.current), {"wind", &out_.wind}}) {
      if (!f.has(key)) continue;
      *to = names(f, key);
      if (static_cast<int>(to->size()) != e.dimensions) {
        f.refuse(key, f.path(key) + " has " + counted(std::ssize(*to), "name") + " for " +
                          counted(e.dimensions, "dimension"));
      }
    }
    if ((e.turning != 0 || f.has("latitude")) && e.dimensions != 2) {
      f.refuse(f.has("latitude") ? "latitude" : "turning",
               "bodies can turn in two dimensions only: experiment.dimensions = 2");
    }
  }

  void baseline(const toml::table& from) {
    const std::vector<std::string> words = names_of(baseline_keys(laws_));
    const TomlFields f(from, "baseline", file_, words);
    for (const std::string& word : words) {
      if (!f.has(word)) continue;
      BaselineLaw law{word, 0, false, f.place(word)};
      const auto* text = f.node(word)->as_string();
      law.fit = text != nullptr && text->get() == "fit";
      if (text != nullptr && !law.fit) {
        f.refuse(word, f.path(word) + " = \"" + text->get() + "\" is neither a number nor \"fit\"");
      }
      if (!law.fit) law.value = f.number(word, "1");
      if (word == "contact" && (law.fit || law.value < 0 || law.value > 1)) {
        f.refuse(word, "baseline.contact is the restitution of contacts, 0 .. 1");
      }
      out_.experiment.baseline.push_back(law);
    }
  }

  static std::vector<NamedAt> names(const TomlFields& f, const std::string& key) {
    std::vector<NamedAt> out;
    for (const auto& [name, place] : f.texts(key)) out.push_back({name, place});
    return out;
  }

  BodyFigures numbers(const TomlFields& f, const std::string& key, const std::string& unit) const {
    BodyFigures out;
    out.place = f.place(key);
    const auto one = [&](const toml::node& node, const std::string& path) {
      const SourcePlace at = place_of(node.source(), file_);
      double value = 0;
      if (const auto* text = node.as_string()) {
        value = read_quantity(text->get(), unit, path, at);
      } else if (node.is_number()) {
        value = node.value<double>().value_or(NAN);
      } else {
        throw InputError(at,
                         path + " is " + described(unit) + ", a list of them, or a table by body");
      }
      if (!(value >= (key == "mass" ? 1e-12 : 0)) || value > 1e12) {
        throw InputError(at, path + " = " + shortest(value) + " is no " + key);
      }
      return value;
    };
    const toml::node& node = *f.node(key);
    if (const auto* list = node.as_array()) {
      for (const toml::node& item : *list) out.values.push_back(one(item, f.path(key)));
    } else if (const auto* by = node.as_table()) {
      for (const auto& [name, item] : *by) {
        out.by_name[std::string(name.str())] =
            one(item, f.path(key) + "." + std::string(name.str()));
      }
    } else {
      out.values.push_back(one(node, f.path(key)));
    }
    return out;
  }

  void recording(const toml::table& from) {
    const TomlFields f(from, "recording", file_, names_of(recording_keys_of_points()));
    f.need("file", "the table of the positions");
    f.need("time", "the name of the column of times, in seconds");
    f.need("x", "the name of the column of positions, or one a body");
    BodyTable t;
    t.file = (fs::path(file_).parent_path() / f.text("file")).lexically_normal().string();
    t.place = f.place("file");
    t.time = {f.text("time"), f.place("time")};
    const auto whole = [&](const char* key, int low, int high, auto& to) {
      if (f.has(key)) to = static_cast<int>(f.whole(key, low, high));
    };
    if (f.has("time_unit")) t.time_unit = number(f, "time_unit", "s", 1e-9);
    whole("header_line", 0, kMostLines, t.layout.header_line);
    whole("first_row", 1, kMostLines, t.layout.first_row);
    whole("every", 1, 1000000, t.every);
    if (f.has("decimal_comma")) t.layout.decimal_comma = f.flag("decimal_comma");
    if (f.has("body")) t.body = {f.text("body"), f.place("body")};
    if (f.has("run")) t.run = {f.text("run"), f.place("run")};
    t.x = names(f, "x");
    const bool flat = out_.experiment.dimensions == 1;
    if (f.has("y") && flat) f.refuse("y", "recording.y needs experiment.dimensions = 2");
    if (!flat) f.need("y", "bodies have two dimensions");
    if (f.has("y")) t.y = names(f, "y");
    if (!flat && t.y.size() != t.x.size())
      f.refuse("y", "recording.y has not as many columns as x");
    if (t.x.size() > 1 && !t.body.name.empty()) {
      f.refuse("body", "recording.body goes with one column x; here every column is a body");
    }
    const std::size_t most = most_together(out_.experiment.dimensions);
    if (t.x.size() > most) f.refuse("x", "more than " + std::to_string(most) + " bodies together");
    if (f.has("mass")) t.mass = numbers(f, "mass", "kg");
    if (f.has("radius")) t.radius = numbers(f, "radius", "m");
    if (f.has("drivers")) t.drivers = names(f, "drivers");
    if (f.has("scale")) {
      if (out_.experiment.geographic) f.refuse("scale", "recording.scale: coordinates are degrees");
      t.scale = number(f, "scale", out_.experiment.unit, 1e-12);
    }
    if (f.has("together")) t.together = f.flag("together");
    if (f.has("held_out")) t.held_out = f.flag("held_out");
    out_.tables.push_back(std::move(t));
  }

  std::string file_;
  const std::vector<std::string>& laws_;
  toml::table root_;
  BodyFile out_;
};

}  // namespace

TomlKeys body_file_keys(const std::vector<std::string>& laws) {
  using namespace toml_key;
  return {needed(table("experiment", experiment_keys(), "bodies and what is known of them")),
          table("baseline", baseline_keys(laws), "laws that are known, with their coefficients"),
          needed(tables("recording", recording_keys_of_points(), "tables of positions"))};
}

BodyFile read_body_file(const std::string& file, const std::vector<std::string>& laws) {
  return Reader(file, laws).read();
}

bool is_body_experiment(const std::string& file) {
  toml::table root;
  try {
    root = parse_toml(read_whole(file), file);
  } catch (const InputError&) {
    return false;
  }
  if (root.contains("tank")) return false;
  const auto body = root["experiment"]["body"].value<std::string>();
  if (body == "point") return true;
  if (!root.contains("baseline")) return false;
  // A message about [baseline] in an experiment of a tank would mislead.
  if (!body || *body == "lily" || *body == "ball") {
    throw InputError(place_of(root["baseline"].node()->source(), file),
                     "[baseline] is of point bodies: say body = \"point\" in [experiment]");
  }
  throw unknown_word(place_of(root["experiment"]["body"].node()->source(), file), "experiment.body",
                     *body, {"lily", "ball", "point"});
}

}  // namespace lilytank
