#include "io/recording_keys.hpp"

#include <algorithm>
#include <functional>

#include "io/scenario_values.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// Words of enums, in the order of their values.
const std::vector<std::string> kBodies{"lily", "ball", "point"};
const std::vector<std::string> kFormats{
    "auto",      "tidy",      "swistrack-tracks", "swistrack-particles",
    "trackpy",   "idtracker", "idtracker-wide",   "trex",
    "fasttrack", "table"};
const std::vector<std::string> kYAxes{"", "up", "down"};
const std::vector<std::string> kAngleUnits{"", "rad", "deg"};
const std::vector<std::string> kTreatments{"keep", "mark", "split", "refuse"};

class Setter {
 public:
  Setter(const Assignment& from, const std::string& prefix, RecordingOptions& options)
      : from_(&from), path_(prefix + "." + from.path()), options_(&options) {}

  void set(const std::string& prefix) {
    const auto all = keys();
    const std::string name = from_->path();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Key& key) { return key.name == name; });
    if (found != all.end()) return found->act();
    std::vector<std::string> names;
    for (const Key& key : all) names.push_back(key.name);
    throw InputError(from_->key_places.front(),
                     "unknown key '" + prefix + "." + name + "'" + did_you_mean(name, names));
  }

 private:
  struct Key {
    std::string name;
    std::function<void()> act;
  };

  std::vector<Key> keys() {
    RecordingOptions& o = *options_;
    std::vector<Key> all{
        {"name", [&] { o.name = text(); }},
        {"body", [&] { word(kBodies, o.body); }},
        {"latches", [&] { o.latches = on(); }},
        {"held_out", [&] { o.held_out = on(); }},
        {"format", [&] { word(kFormats, o.format); }},
        {"rate", [&] { o.rate = number("1/s", 1e-4, 1e5); }},
        {"time_unit", [&] { o.time_unit = number("s", 1e-9, 1e6); }},
        {"pixel", [&] { o.calibration.pixel = number("m", 1e-9, 1e6); }},
        {"y_axis", [&] { word(kYAxes, o.calibration.y_axis); }},
        {"angle_unit", [&] { word(kAngleUnits, o.calibration.angles); }},
        {"origin", [&] { origin(2); }},
        {"tank_circle", [&] { origin(3); }},
    };
    column_keys(all);
    check_keys(all);
    return all;
  }

  void column_keys(std::vector<Key>& all) {
    ColumnNames& c = options_->columns;
    for (const auto& [name, target] : {std::pair{"frame", &c.frame},
                                       {"time", &c.time},
                                       {"id", &c.id},
                                       {"x", &c.x},
                                       {"y", &c.y},
                                       {"theta", &c.theta}}) {
      all.push_back({std::string("columns.") + name, [this, to = target] { *to = text(); }});
    }
  }

  void check_keys(std::vector<Key>& all) {
    CheckRules& r = options_->rules;
    for (int i = 0; i < kChecks; ++i) {
      const auto check = static_cast<Check>(i);
      all.push_back({"checks." + check_word(check),
                     [this, check] { word(kTreatments, options_->rules[check]); }});
    }
    const std::vector<Key> limits{
        {"checks.longest_gap", [&] { r.longest_gap = number("s", 0, 1e6); }},
        {"checks.fastest", [&] { r.fastest = number("m/s", 1e-6, 1e6); }},
        {"checks.least_jump", [&] { r.least_jump = number("m", 0, 1e6); }},
        {"checks.least_turn", [&] { r.least_turn = number("rad", 0, 4); }},
        {"checks.beyond_tank", [&] { r.beyond_tank = number("m", 0, 1e6); }},
        {"checks.clock_error", [&] { r.clock_error = number("1", 0, 0.5); }},
    };
    all.insert(all.end(), limits.begin(), limits.end());
  }

  std::string text() const { return text_of(*from_, path_); }

  double number(const std::string& unit, double low, double high) const {
    const double value = number_of(*from_, path_, unit);
    if (value >= low && value <= high) return value;
    throw InputError(from_->place, path_ + " = " + shortest(value) + " is outside " +
                                       shortest(low) + " .. " + shortest(high) +
                                       (unit == "1" ? "" : " " + unit));
  }

  /// A switch, or "on" and "off".
  bool on() const {
    if (const auto* value = std::get_if<bool>(&from_->value)) return *value;
    const auto* value = std::get_if<std::string>(&from_->value);
    if (value != nullptr && (*value == "on" || *value == "off")) return *value == "on";
    throw InputError(from_->place, path_ + " is \"on\" or \"off\", or true or false");
  }

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
  void origin(std::size_t size) const {
    std::vector<double> values;
    if (const auto* list = std::get_if<Numbers>(&from_->value)) {
      values.assign(list->begin(), list->end());
    } else if (const auto* reals = std::get_if<Reals>(&from_->value)) {
      values = *reals;
    }
    const bool fits = values.size() == size && (size == 2 || values[2] > 0);
    if (!fits) {
      throw InputError(from_->place, path_ +
                                         (size == 2 ? " is [x, y] of the tank's centre"
                                                    : " is [x, y, radius] of the tank") +
                                         " in the file's units");
    }
    Calibration& c = options_->calibration;
    c.has_origin = true, c.origin_x = values[0], c.origin_y = values[1];
    if (size == 3) c.circle_radius = values[2];
  }

  const Assignment* from_;
  std::string path_;
  RecordingOptions* options_;
};

}  // namespace

std::string format_word(RecordingFormat format) {
  return kFormats[static_cast<std::size_t>(format)];
}

std::string treatment_word(Treatment treatment) {
  return kTreatments[static_cast<std::size_t>(treatment)];
}

std::string check_word(Check check) {
  constexpr std::array<const char*, kChecks> words{
      "gap", "duplicate", "spike", "jump", "swap", "speed", "outside", "clock", "units", "heading"};
  return words[static_cast<std::size_t>(check)];
}

void assign_recording_option(const Assignment& from, const std::string& prefix,
                             RecordingOptions& options) {
  Setter(from, prefix, options).set(prefix);
}

}  // namespace lilytank
