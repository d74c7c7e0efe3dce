#include "recording/recording_keys.hpp"

#include <algorithm>
#include <functional>

#include "io/scenario_values.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// Words of enums, in the order of their values.
const std::vector<std::string> kBodies{"lily", "ball", "point"};
const std::vector<std::string> kFormats{"auto",
                                        "tidy",
                                        "swistrack-tracks",
                                        "swistrack-particles",
                                        "trackpy",
                                        "idtracker",
                                        "idtracker-wide",
                                        "trex",
                                        "fasttrack",
                                        "boxes",
                                        "table"};
const std::vector<std::string> kYAxes{"", "up", "down"};
const std::vector<std::string> kAngleUnits{"", "rad", "deg"};
const std::vector<std::string> kTreatments{"keep", "mark", "split", "refuse"};

class Value;
struct Key {
  TomlKey about;
  std::function<void(const Value&)> act;
};

/// One value, read as what its key wants.
class Value {
 public:
  Value(const Assignment& from, const std::string& prefix, const TomlKey& key)
      : from_(&from), key_(&key), path_(prefix + "." + from.path()) {}

  std::string text() const { return text_of(*from_, path_); }

  double number() const {
    const double value = number_of(*from_, path_, key_->unit);
    if (value >= key_->low && value <= key_->high) return value;
    throw InputError(from_->place, path_ + " = " + shortest(value) + " is outside " +
                                       shortest(key_->low) + " .. " + shortest(key_->high) +
                                       (key_->unit == "1" ? "" : " " + key_->unit));
  }

  std::int64_t whole() const {
    const auto low = static_cast<std::int64_t>(key_->low);
    const auto high = static_cast<std::int64_t>(key_->high);
    const auto* value = std::get_if<std::int64_t>(&from_->value);
    if (value != nullptr && *value >= low && *value <= high) return *value;
    throw InputError(from_->place, path_ + " is a whole number, " + std::to_string(low) + " .. " +
                                       std::to_string(high));
  }

  /// A switch, or "on" and "off".
  bool on() const {
    if (const auto* value = std::get_if<bool>(&from_->value)) return *value;
    const auto* value = std::get_if<std::string>(&from_->value);
    if (value != nullptr && (*value == "on" || *value == "off")) return *value == "on";
    throw InputError(from_->place, path_ + " is \"on\" or \"off\", or true or false");
  }

  /// An enum by the key's words, in the order of its values; empty words cannot be given.
  template <class Enum>
  void word(Enum& target) const {
    const std::vector<std::string>& words = key_->words;
    const std::string value = text();
    const auto found = std::find(words.begin(), words.end(), value);
    if (found == words.end() || value.empty()) {
      std::vector<std::string> shown;
      std::copy_if(words.begin(), words.end(), std::back_inserter(shown),
                   [](const std::string& w) { return !w.empty(); });
      throw unknown_word(from_->place, path_, value, shown);
    }
    target = static_cast<Enum>(found - words.begin());
  }

  /// [x, y] of the tank's centre, or [x, y, radius] of its circle, in the file's units.
  void origin(std::size_t size, Calibration& to) const {
    std::vector<double> values;
    if (const auto* list = std::get_if<Numbers>(&from_->value)) {
      values.assign(list->begin(), list->end());
    } else if (const auto* reals = std::get_if<Reals>(&from_->value)) {
      values = *reals;
    }
    const auto sane = [](double v) { return v >= -1e12 && v <= 1e12; };
    const bool fits = values.size() == size && std::all_of(values.begin(), values.end(), sane) &&
                      (size == 2 || values[2] > 1e-9);
    if (!fits) {
      throw InputError(from_->place, path_ +
                                         (size == 2 ? " is [x, y] of the tank's centre"
                                                    : " is [x, y, radius] of the tank") +
                                         " in the file's units");
    }
    to.has_origin = true, to.origin_x = values[0], to.origin_y = values[1];
    if (size == 3) to.circle_radius = values[2];
  }

 private:
  const Assignment* from_;
  const TomlKey* key_;
  std::string path_;
};

/// Does what the key of the assignment's name does.
void act(const Assignment& from, const std::string& prefix, const std::vector<Key>& keys) {
  const std::string name = from.path();
  const auto found = std::find_if(keys.begin(), keys.end(),
                                  [&](const Key& key) { return key.about.name == name; });
  if (found != keys.end()) return found->act(Value(from, prefix, found->about));
  std::vector<std::string> names;
  for (const Key& key : keys) names.push_back(key.about.name);
  throw InputError(from.key_places.front(),
                   "unknown key '" + prefix + "." + name + "'" + did_you_mean(name, names));
}

using toml_key::number, toml_key::on_off, toml_key::text, toml_key::whole, toml_key::word;

void column_keys(ColumnNames& c, std::vector<Key>& keys) {
  for (const auto& [name, target] : {std::pair{"frame", &c.frame},
                                     {"time", &c.time},
                                     {"id", &c.id},
                                     {"x", &c.x},
                                     {"y", &c.y},
                                     {"theta", &c.theta}}) {
    keys.push_back({text(std::string("columns.") + name, "the file's name of this column"),
                    [to = target](const Value& v) { *to = v.text(); }});
  }
}

void check_keys(CheckRules& r, std::vector<Key>& keys) {
  for (int i = 0; i < kChecks; ++i) {
    const auto check = static_cast<Check>(i);
    keys.push_back({word("checks." + check_word(check), kTreatments, "what is done about it"),
                    [&r, check](const Value& v) { v.word(r[check]); }});
  }
  const auto limit = [&](const TomlKey& key, double& to) {
    keys.push_back({key, [&to](const Value& v) { to = v.number(); }});
  };
  limit(number("checks.longest_gap", "s", 0, 1e6, "a longer one splits a track"), r.longest_gap);
  limit(number("checks.fastest", "m/s", 1e-6, 1e6, "speed of a body"), r.fastest);
  limit(number("checks.least_jump", "m", 0, 1e6, "a shorter one is motion"), r.least_jump);
  limit(number("checks.least_turn", "rad", 0, 4, "a smaller one is motion"), r.least_turn);
  limit(number("checks.beyond_tank", "m", 0, 1e6, "how far a body may be outside"), r.beyond_tank);
  limit(number("checks.clock_error", "1", 0, 0.5, "share by which time and frames may differ"),
        r.clock_error);
}

std::vector<Key> recording_keys_of(RecordingOptions& o) {
  constexpr std::int64_t kMostLines = 1'000'000'000;
  Calibration& c = o.calibration;
  std::vector<Key> keys{
      {text("name", "of the recording in reports"), [&](const Value& v) { o.name = v.text(); }},
      {word("body", kBodies, "what was recorded"), [&](const Value& v) { v.word(o.body); }},
      {on_off("latches", "whether modules could latch"),
       [&](const Value& v) { o.latches = v.on(); }},
      {on_off("held_out", "kept for showing; nothing is fitted to it"),
       [&](const Value& v) { o.held_out = v.on(); }},
      {word("format", kFormats, "of the file (auto)"), [&](const Value& v) { v.word(o.format); }},
      {number("rate", "1/s", 1e-9, 1e6, "frames per second"),
       [&](const Value& v) { o.rate = v.number(); }},
      {whole("header_line", 0, kMostLines, "line of the columns' names; 0: there is none"),
       [&](const Value& v) { o.layout.header_line = static_cast<int>(v.whole()); }},
      {whole("first_row", 1, kMostLines, "line of the first row of numbers"),
       [&](const Value& v) { o.layout.first_row = static_cast<int>(v.whole()); }},
      {whole("most_rows", 1, 2 * kMostLines, "rows that are read at most"),
       [&](const Value& v) { o.most_rows = v.whole(); }},
      {on_off("decimal_comma", "numbers as 0,25"),
       [&](const Value& v) { o.layout.decimal_comma = v.on(); }},
      {number("time_unit", "s", 1e-9, 1e6, "unit of the column of times"),
       [&](const Value& v) { o.time_unit = v.number(); }},
      {word("tank", {"none", "round"}, "whether there is a wall"),
       [&](const Value& v) { v.word(o.in_tank); }},
      {number("pixel", "m", 1e-9, 1e6, "length of a pixel"),
       [&](const Value& v) { c.pixel = v.number(); }},
      {word("y_axis", kYAxes, "direction of the file's y"),
       [&](const Value& v) { v.word(c.y_axis); }},
      {word("angle_unit", kAngleUnits, "of headings"), [&](const Value& v) { v.word(c.angles); }},
      {toml_key::numbers("origin", "[x, y] of the tank's centre, in the file's units"),
       [&](const Value& v) { v.origin(2, c); }},
      {toml_key::numbers("tank_circle", "[x, y, radius] of the tank, in the file's units"),
       [&](const Value& v) { v.origin(3, c); }},
  };
  column_keys(o.columns, keys);
  check_keys(o.rules, keys);
  return keys;
}

Key further_key(bool& further) {
  return {on_off("further", "the file's recordings are added to those of earlier files"),
          [&further](const Value& v) { further = v.on(); }};
}

}  // namespace

std::string format_word(RecordingFormat format) {
  return kFormats[static_cast<std::size_t>(format)];
}

std::string treatment_word(Treatment treatment) {
  return kTreatments[static_cast<std::size_t>(treatment)];
}

std::string check_word(Check check) {
  constexpr std::array<const char*, kChecks> words{
      "gap",     "duplicate", "spike", "jump",    "swap",   "link",   "speed",
      "outside", "clock",     "units", "heading", "repeat", "columns"};
  return words[static_cast<std::size_t>(check)];
}

void assign_recording_option(const Assignment& from, const std::string& prefix,
                             RecordingOptions& options) {
  act(from, prefix, recording_keys_of(options));
}

void assign_experiment_option(const Assignment& from, RecordingOptions& options, bool& further) {
  std::vector<Key> keys = recording_keys_of(options);
  keys.push_back(further_key(further));
  act(from, "experiment", keys);
}

TomlKeys experiment_tables() {
  RecordingOptions options;
  TomlKeys each;
  for (const Key& key : recording_keys_of(options)) each.push_back(key.about);
  TomlKeys recording = each;
  recording.insert(recording.begin(),
                   toml_key::needed(text("file", "of the tracks; * is a wildcard")));
  recording.push_back(text("events", "file of the modules' event log"));
  bool further = false;
  TomlKeys experiment = each;
  experiment.push_back(further_key(further).about);
  return {toml_key::table("experiment", nested(experiment), "holds for all recordings"),
          toml_key::tables("recording", nested(recording), "one file of tracks, or several by *")};
}

void assign_camera_option(const Assignment& from, Camera& c) {
  constexpr std::int64_t kLargestSeed = 1'000'000'000'000'000'000;
  std::vector<Key> keys;
  const auto limited = [&](const char* name, const char* unit, double low, double high,
                           double& to) {
    keys.push_back({number(name, unit, low, high, ""), [&](const Value& v) { to = v.number(); }});
  };
  limited("rate", "1/s", 1e-3, 1e5, c.rate);
  limited("position_noise", "m", 0, 1, c.position_noise);
  limited("heading_noise", "rad", 0, 1, c.heading_noise);
  limited("dropped", "1", 0, 1, c.dropped);
  limited("missed", "1", 0, 1, c.missed);
  limited("latency", "s", 0, 100, c.latency);
  limited("swaps", "1/s", 0, 1000, c.swaps);
  limited("swap_distance", "m", 0, 10, c.swap_distance);
  limited("lens", "1/m^2", -5, 5, c.lens);
  limited("tilt", "rad", 0, 0.5, c.tilt);
  limited("tilt_direction", "rad", -7, 7, c.tilt_direction);
  limited("height", "m", 0.1, 100, c.height);
  keys.push_back({on_off("headings", ""), [&](const Value& v) { c.headings = v.on(); }});
  keys.push_back({whole("seed", 0, kLargestSeed, ""),
                  [&](const Value& v) { c.seed = static_cast<std::uint64_t>(v.whole()); }});
  act(from, "camera", keys);
}

RecordingFormat format_to_write(const std::string& word, const SourcePlace& place) {
  std::vector<std::string> written(kFormats.begin(), kFormats.end());
  std::erase(written, format_word(RecordingFormat::automatic));
  std::erase(written, format_word(RecordingFormat::boxes));
  std::erase(written, format_word(RecordingFormat::table));
  if (std::find(written.begin(), written.end(), word) == written.end()) {
    throw unknown_word(place, "format", word, written);
  }
  const auto found = std::find(kFormats.begin(), kFormats.end(), word);
  return static_cast<RecordingFormat>(found - kFormats.begin());
}

}  // namespace lilytank
