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

struct Key {
  std::string name;
  std::function<void()> act;
};

/// One value, read as what its key wants.
class Value {
 public:
  Value(const Assignment& from, const std::string& prefix)
      : from_(&from), prefix_(prefix), path_(prefix + "." + from.path()) {}

  /// Does what the key of this name does.
  void act(const std::vector<Key>& keys) const {
    const std::string name = from_->path();
    const auto found =
        std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
    if (found != keys.end()) return found->act();
    std::vector<std::string> names;
    for (const Key& key : keys) names.push_back(key.name);
    throw InputError(from_->key_places.front(),
                     "unknown key '" + prefix_ + "." + name + "'" + did_you_mean(name, names));
  }

  std::string text() const { return text_of(*from_, path_); }

  double number(const std::string& unit, double low, double high) const {
    const double value = number_of(*from_, path_, unit);
    if (value >= low && value <= high) return value;
    throw InputError(from_->place, path_ + " = " + shortest(value) + " is outside " +
                                       shortest(low) + " .. " + shortest(high) +
                                       (unit == "1" ? "" : " " + unit));
  }

  std::int64_t whole(std::int64_t low, std::int64_t high) const {
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

  /// An enum by its words, in the order of its values; empty words cannot be given.
  template <class Enum>
  void word(const std::vector<std::string>& words, Enum& target) const {
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
  std::string prefix_, path_;
};

void column_keys(const Value& v, ColumnNames& c, std::vector<Key>& keys) {
  for (const auto& [name, target] : {std::pair{"frame", &c.frame},
                                     {"time", &c.time},
                                     {"id", &c.id},
                                     {"x", &c.x},
                                     {"y", &c.y},
                                     {"theta", &c.theta}}) {
    keys.push_back({std::string("columns.") + name, [&v, to = target] { *to = v.text(); }});
  }
}

void check_keys(const Value& v, CheckRules& r, std::vector<Key>& keys) {
  for (int i = 0; i < kChecks; ++i) {
    const auto check = static_cast<Check>(i);
    keys.push_back(
        {"checks." + check_word(check), [&v, &r, check] { v.word(kTreatments, r[check]); }});
  }
  const std::vector<Key> limits{
      {"checks.longest_gap", [&] { r.longest_gap = v.number("s", 0, 1e6); }},
      {"checks.fastest", [&] { r.fastest = v.number("m/s", 1e-6, 1e6); }},
      {"checks.least_jump", [&] { r.least_jump = v.number("m", 0, 1e6); }},
      {"checks.least_turn", [&] { r.least_turn = v.number("rad", 0, 4); }},
      {"checks.beyond_tank", [&] { r.beyond_tank = v.number("m", 0, 1e6); }},
      {"checks.clock_error", [&] { r.clock_error = v.number("1", 0, 0.5); }},
  };
  keys.insert(keys.end(), limits.begin(), limits.end());
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
                             RecordingOptions& o) {
  const Value v(from, prefix);
  constexpr std::int64_t kMostLines = 1'000'000'000;
  std::vector<Key> keys{
      {"name", [&] { o.name = v.text(); }},
      {"body", [&] { v.word(kBodies, o.body); }},
      {"latches", [&] { o.latches = v.on(); }},
      {"held_out", [&] { o.held_out = v.on(); }},
      {"format", [&] { v.word(kFormats, o.format); }},
      {"rate", [&] { o.rate = v.number("1/s", 1e-9, 1e6); }},
      {"header_line", [&] { o.layout.header_line = static_cast<int>(v.whole(0, kMostLines)); }},
      {"first_row", [&] { o.layout.first_row = static_cast<int>(v.whole(1, kMostLines)); }},
      {"most_rows", [&] { o.most_rows = v.whole(1, 2 * kMostLines); }},
      {"decimal_comma", [&] { o.layout.decimal_comma = v.on(); }},
      {"time_unit", [&] { o.time_unit = v.number("s", 1e-9, 1e6); }},
      {"tank",
       [&] {
         v.word({"none", "round"}, o.in_tank);
       }},
      {"pixel", [&] { o.calibration.pixel = v.number("m", 1e-9, 1e6); }},
      {"y_axis", [&] { v.word(kYAxes, o.calibration.y_axis); }},
      {"angle_unit", [&] { v.word(kAngleUnits, o.calibration.angles); }},
      {"origin", [&] { v.origin(2, o.calibration); }},
      {"tank_circle", [&] { v.origin(3, o.calibration); }},
  };
  column_keys(v, o.columns, keys);
  check_keys(v, o.rules, keys);
  v.act(keys);
}

void assign_camera_option(const Assignment& from, Camera& c) {
  const Value v(from, "camera");
  constexpr std::int64_t kLargestSeed = 1'000'000'000'000'000'000;
  v.act({
      {"rate", [&] { c.rate = v.number("1/s", 1e-3, 1e5); }},
      {"position_noise", [&] { c.position_noise = v.number("m", 0, 1); }},
      {"heading_noise", [&] { c.heading_noise = v.number("rad", 0, 1); }},
      {"dropped", [&] { c.dropped = v.number("1", 0, 1); }},
      {"missed", [&] { c.missed = v.number("1", 0, 1); }},
      {"latency", [&] { c.latency = v.number("s", 0, 100); }},
      {"swaps", [&] { c.swaps = v.number("1/s", 0, 1000); }},
      {"swap_distance", [&] { c.swap_distance = v.number("m", 0, 10); }},
      {"lens", [&] { c.lens = v.number("1/m^2", -5, 5); }},
      {"tilt", [&] { c.tilt = v.number("rad", 0, 0.5); }},
      {"tilt_direction", [&] { c.tilt_direction = v.number("rad", -7, 7); }},
      {"height", [&] { c.height = v.number("m", 0.1, 100); }},
      {"headings", [&] { c.headings = v.on(); }},
      {"seed", [&] { c.seed = static_cast<std::uint64_t>(v.whole(0, kLargestSeed)); }},
  });
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
