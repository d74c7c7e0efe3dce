// From a study file to its settings.
#include "lilytank/study.hpp"

#include <algorithm>
#include <map>

#include "io/scenario_layers.hpp"
#include "jobs/early_end.hpp"
#include "study/axes.hpp"
#include "study/study_file.hpp"
#include "study/study_inputs.hpp"
#include "study/study_rows.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kMostSettings = 100000;

/// One value of an axis.
struct Choice {
  std::string text;     ///< as the author wrote it
  double position = 0;  ///< among the axis' values
  Assignment value;     ///< of an axis with a path
  std::string overlay;  ///< of an axis of overlays
};

std::string as_written(const TomlValue& value) {
  if (const auto* v = std::get_if<bool>(&value)) return *v ? "true" : "false";
  if (const auto* v = std::get_if<std::int64_t>(&value)) return std::to_string(*v);
  if (const auto* v = std::get_if<double>(&value)) return shortest(*v);
  if (const auto* v = std::get_if<std::string>(&value)) return *v;
  return kind_of(value);  // the scenario will refuse it
}

/// "chain5" of "../chain5.toml".
std::string stem(const std::string& file) {
  const auto begin = file.rfind('/') + 1;
  const auto end = file.ends_with(".toml") ? file.size() - 5 : file.size();
  return file.substr(begin, end - begin);
}

std::vector<Choice> choices_of(const StudyAxis& axis, const StudyFile& file, int index) {
  std::vector<Choice> out;
  const auto add = [&](const std::string& text, const Assignment& value, std::string overlay) {
    out.push_back({text, static_cast<double>(out.size()), value, std::move(overlay)});
  };
  for (const std::string& overlay : axis.overlays) add(stem(overlay), {}, overlay);
  for (const Assignment& value : axis.values) add(as_written(value.value), value, "");
  for (std::size_t i = 0; i < axis.labels.size(); ++i) out[i].text = axis.labels[i];
  if (!axis.range) return out;
  const AxisRange& range = *axis.range;
  for (const double number :
       range.latin ? latin_values(range, file.samples, file.seed, index) : range_values(range)) {
    Assignment value = axis.path;
    value.place = axis.place;
    if (range.whole) {
      value.value = static_cast<std::int64_t>(number);
    } else {
      value.value = number;
    }
    add(range.latin && !range.whole ? significant(number, 4) : as_written(value.value), value, "");
  }
  return out;
}

/// What an axis is called in labels: the end of its path.
std::string short_name(const StudyAxis& axis) {
  if (axis.path.keys.empty() || axis.name != axis.path.path()) return axis.name;
  const auto& keys = axis.path.keys;
  const bool two = keys.size() > 2;  // of a rule or a force: its name as well
  return two ? keys[keys.size() - 2] + "." + keys.back() : keys.back();
}

/// Copies that a world can make, under whichever of its rulesets makes most.
int most_copies(const Model& model) {
  int most = 0;
  for (const Ruleset& rules : model.rulesets) {
    most = std::max(most, possible_copies(rules, model.module.count));
  }
  return most;
}

std::string without_quotes(const std::string& toml) {
  const bool quoted = toml.size() >= 2 && toml.front() == '"';
  return quoted ? toml.substr(1, toml.size() - 2) : toml;
}

}  // namespace

struct Study::Source {
  Source(const std::string& path, std::vector<std::string> sets)
      : file(read_study_file(path)), path_(path) {
    plan.sets = sets;
    file.seed = take_seed(sets).value_or(file.seed);
    overrides_ = read_layers({}, sets).back();
    check_overrides();
    for (std::size_t i = 0; i < file.axes.size(); ++i) {
      choices_.push_back(choices_of(file.axes[i], file, static_cast<int>(i)));
    }
    make_plan();
  }

  Scenario build(const std::vector<const Choice*>& chosen) const {
    std::vector<std::string> files = file.scenarios;
    Layer values;
    for (const Choice* choice : chosen) {
      if (choice->overlay.empty()) {
        values.values.push_back(choice->value);
      } else {
        files.push_back(choice->overlay);
      }
    }
    std::vector<Layer> layers = read_layers(files, {});
    layers.push_back(std::move(values));
    layers.push_back(overrides_);
    Layer seed;
    seed.values.push_back({{"run", "seed"}, {{}, {}}, std::int64_t{0}, {}, "", ""});
    layers.push_back(std::move(seed));
    return build_scenario(std::move(layers));
  }

  std::vector<const Choice*> choices(int setting) const {
    // Mixed radix, the last axis fastest; all latin axes together are one digit, the last one.
    auto rest = static_cast<std::size_t>(setting);
    std::vector<const Choice*> chosen(choices_.size());
    const auto take = [&](std::size_t n) {
      const std::size_t digit = rest % n;
      rest /= n;
      return digit;
    };
    if (file.samples > 0) {
      const std::size_t sample = take(static_cast<std::size_t>(file.samples));
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (latin(i)) chosen[i] = &choices_[i][sample];
      }
    }
    for (std::size_t i = chosen.size(); i-- > 0;) {
      if (!latin(i)) chosen[i] = &choices_[i][take(choices_[i].size())];
    }
    return chosen;
  }

  std::vector<std::string> inputs() const {
    std::vector<std::string> files = file.scenarios;
    Layer values;
    for (const StudyAxis& axis : file.axes) {
      files.insert(files.end(), axis.overlays.begin(), axis.overlays.end());
      values.values.insert(values.values.end(), axis.values.begin(), axis.values.end());
    }
    std::vector<Layer> layers = read_layers(files, {});
    layers.push_back(std::move(values));
    layers.push_back(overrides_);
    files.push_back(path_);
    return with_files_of(layers, std::move(files));
  }

  StudyFile file;
  StudyPlan plan;

 private:
  bool latin(std::size_t axis) const {
    return file.axes[axis].range && file.axes[axis].range->latin;
  }

  void check_overrides() const {
    for (const Assignment& value : overrides_.values) {
      const std::string name = value.path();
      for (const StudyAxis& axis : file.axes) {
        if (axis.path.keys != value.keys) continue;
        throw InputError(value.place,
                         "'" + name + "' is an axis of the study, see " + axis.place.text());
      }
    }
  }

  std::size_t settings() const {
    std::size_t n = static_cast<std::size_t>(std::max(1, file.samples));
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      if (!latin(i)) n *= choices_[i].size();
      if (n > kMostSettings) {
        throw InputError({path_, 0, 0}, "the axes have more than " + std::to_string(kMostSettings) +
                                            " combinations");
      }
    }
    return n;
  }

  void make_plan() {
    plan.name = file.name;
    plan.scenarios = file.scenarios;
    plan.seed = file.seed;
    plan.replicates = file.replicates;
    plan.stop = file.stop;
    plan.until_settled = file.until_settled;
    for (const StudyAxis& axis : file.axes) plan.axes.push_back(axis.name);
    const auto n = static_cast<int>(settings());
    std::map<std::uint64_t, std::string> seen;
    for (int i = 0; i < n; ++i) {
      plan.settings.push_back(make_setting(choices(i)));
      const Setting& setting = plan.settings.back();
      const auto [same, fresh] = seen.emplace(setting.identity, setting.label);
      if (fresh) continue;
      throw InputError({path_, 0, 0}, "settings '" + same->second + "' and '" + setting.label +
                                          "' are one and the same scenario");
    }
  }

  Setting make_setting(const std::vector<const Choice*>& chosen) const {
    const Scenario scenario = build(chosen);
    Setting out;
    out.duration = scenario.duration;
    out.identity = scenario.identity;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const StudyAxis& axis = file.axes[i];
      const Choice& choice = *chosen[i];
      // Names that were given to overlays speak for themselves.
      const bool named = axis.path.keys.empty() && !axis.labels.empty();
      out.label += (i == 0 ? "" : ", ") + (named ? "" : short_name(axis) + "=") + choice.text;
      const std::string path = axis.path.path();
      const auto entry =
          std::find_if(scenario.entries.begin(), scenario.entries.end(),
                       [&](const ScenarioEntry& e) { return e.path == path && !path.empty(); });
      const bool known = entry != scenario.entries.end();
      out.texts.push_back(known ? without_quotes(entry->value) : choice.text);
      out.values.push_back(parse_number(out.texts.back()).value_or(choice.position));
    }
    if (out.label.empty()) out.label = plan.name;
    refuse_early_end(scenario, "a study leaves completed runs with until = \"settled\"");
    check_stop(scenario.model, out.label);
    try {
      initial_state(scenario.model, plan.seed_of(0));  // do the bodies fit?
    } catch (const InputError& e) {
      throw InputError(out.label + ": " + e.what());
    }
    return out;
  }

  // A time that no world of a setting can tell would never be known well enough to stop.
  void check_stop(const Model& model, const std::string& label) const {
    if (!file.stop) return;
    const int most = most_copies(model);
    if (copies_needed(file.stop->metric) <= most) return;
    throw InputError(file.stop_place, "stop.metric = \"" + file.stop->metric + "\", but in '" +
                                          label + "' there are " +
                                          std::to_string(model.module.count) +
                                          " modules: enough for " + std::to_string(most) +
                                          (most == 1 ? " copy" : " copies"));
  }

  std::string path_;
  Layer overrides_;
  std::vector<std::vector<Choice>> choices_;  // [axis][value]
};

Study::Study(const std::string& file, const std::vector<std::string>& sets)
    : source_(std::make_unique<const Source>(file, sets)) {}
Study::~Study() = default;
Study::Study(Study&&) noexcept = default;

const StudyPlan& Study::plan() const {
  return source_->plan;
}

std::vector<std::string> Study::inputs() const {
  return source_->inputs();
}

Scenario Study::scenario(int setting) const {
  Scenario out = source_->build(source_->choices(setting));
  const Setting& planned = source_->plan.settings[static_cast<std::size_t>(setting)];
  if (out.identity == planned.identity) return out;
  throw InputError("the files of setting '" + planned.label +
                   "' have changed since the study "
                   "began; give the same command again");
}

}  // namespace lilytank
