#include "study_names.hpp"
#include "statistics/undefined.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "io/scenario_keys.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

// What a label says of each axis: "count=15" and "p_e" of "count=15, p_e". Nothing where it is not
// written so.
std::vector<std::string> parts_of(const std::string& label, std::size_t axes) {
  if (axes < 2) return {label};
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= label.size();) {
    const std::size_t to = std::min(label.find(", ", from), label.size());
    parts.push_back(label.substr(from, to - from));
    from = to + 2;
  }
  if (parts.size() != axes) parts.clear();
  return parts;
}

using Parts = std::vector<std::vector<std::string>>;  // [setting][axis]

Parts all_parts(const StudySummary& summary) {
  Parts all;
  for (const SettingSummary& setting : summary.settings) {
    all.push_back(parts_of(setting.label, summary.axes.size()));
    if (all.back().empty()) return {};
  }
  return all;
}

std::string key_of(const std::string& part) {
  const std::size_t at = part.find('=');
  return at == std::string::npos ? "" : part.substr(0, at);
}

bool differ(const Parts& parts, std::size_t axis) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const auto& of) { return of[axis] != parts[0][axis]; });
}

bool same_keys(const Parts& parts, std::size_t axis) {
  const std::string key = key_of(parts[0][axis]);
  return std::all_of(parts.begin(), parts.end(),
                     [&](const auto& of) { return key_of(of[axis]) == key; });
}

bool shows_number(const std::string& part) {
  const std::string_view value = trimmed(std::string_view(part).substr(part.rfind('=') + 1));
  return parse_number(value.substr(0, value.find(' '))).has_value();
}

// The axis' values in rising order, each once, of settings with runs.
std::set<double> values_of(const StudySummary& summary, std::size_t axis) {
  std::set<double> values;
  for (const SettingSummary& s : summary.settings) {
    if (s.runs > 0 && axis < s.values.size()) values.insert(s.values[axis]);
  }
  return values;
}

// The first and the last, and those between evenly by their ranks: `most` at most.
std::vector<double> some_of(const std::set<double>& values, std::size_t most) {
  const std::vector<double> all(values.begin(), values.end());
  if (all.size() <= most) return all;
  std::vector<double> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(all[i * (all.size() - 1) / (most - 1)]);
  return some;
}

// By what they differ in.
SettingNames names_by_parts(const StudySummary& summary, const Parts& parts) {
  SettingNames out;
  std::vector<std::size_t> axes;
  for (std::size_t a = 0; !parts.empty() && a < parts[0].size(); ++a) {
    if (differ(parts, a)) axes.push_back(a);
  }
  std::vector<std::string> keys;
  for (const std::size_t a : axes) {
    const std::string key = key_of(parts[0][a]);
    keys.push_back(key.empty() || !same_keys(parts, a) ? summary.axes[a] : key);
  }
  if (axes.size() > 1) out.title = joined(keys, ", ");
  for (std::size_t s = 0; s < summary.settings.size(); ++s) {
    const auto said = [&](std::size_t a) {
      const std::string& part = parts[s][a];
      return axes.size() > 1 && same_keys(parts, a) ? part.substr(part.find('=') + 1) : part;
    };
    out.names.push_back(axes.empty() ? summary.settings[s].label : joined(axes, ", ", said));
  }
  out.shades.assign(out.names.size(), kUndefined);
  return out;
}

}  // namespace

std::size_t settings_with_runs(const StudySummary& summary) {
  return static_cast<std::size_t>(
      std::count_if(summary.settings.begin(), summary.settings.end(),
                    [](const SettingSummary& s) { return s.runs > 0; }));
}

std::vector<std::size_t> number_axes(const StudySummary& summary) {
  std::vector<std::size_t> axes;
  const Parts parts = all_parts(summary);
  for (std::size_t a = 0; !parts.empty() && a < summary.axes.size(); ++a) {
    bool numbers = values_of(summary, a).size() > 1;
    for (std::size_t s = 0; s < parts.size(); ++s) {
      const SettingSummary& setting = summary.settings[s];
      if (setting.runs == 0) continue;
      numbers = numbers && a < setting.values.size() && shows_number(parts[s][a]);
    }
    if (numbers) axes.push_back(a);
  }
  return axes;
}

SettingNames shades_by(const StudySummary& summary, std::size_t axis) {
  SettingNames out;
  out.title = axis_label(summary.axes[axis]);
  const std::size_t n = summary.settings.size();
  out.names.assign(n, ""), out.shades.assign(n, kUndefined);
  const std::set<double> values = values_of(summary, axis);
  const double low = *values.begin(), high = *values.rbegin();
  const bool log = value_axis(summary, axis).log;
  for (std::size_t s = 0; s < n; ++s) {
    if (summary.settings[s].runs == 0) continue;
    const double v = summary.settings[s].values[axis];
    out.shades[s] = log ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
  }
  for (const double named : some_of(values, 5)) {
    for (std::size_t s = 0; s < n; ++s) {
      const SettingSummary& setting = summary.settings[s];
      if (setting.runs == 0 || setting.values[axis] != named) continue;
      out.names[s] = significant(named, 4);
      break;
    }
  }
  return out;
}

SettingNames names_of(const StudySummary& summary) {
  if (settings_with_runs(summary) > kNamedUpTo) {
    const std::vector<std::size_t> axes = number_axes(summary);
    if (!axes.empty()) return shades_by(summary, axes[0]);
  }
  return names_by_parts(summary, all_parts(summary));
}

std::string axis_label(const std::string& path) {
  ScenarioDraft draft;
  for (const ScenarioKey& key : scenario_keys(draft)) {
    const bool unit = !key.unit.empty() && key.unit != "1";
    if (key.path == path) return unit ? path + " (" + key.unit + ")" : path;
  }
  return path;
}

double ValueAxis::beside(double value, double share) const {
  return log ? value * std::pow(high / low, share) : value + share * (high - low);
}

ValueAxis value_axis(const StudySummary& summary, std::size_t axis) {
  const std::set<double> values = values_of(summary, axis);
  ValueAxis out{*values.begin(), *values.rbegin(), false};
  out.log = values.size() > 2 && out.low > 0 && out.high / out.low > 30;
  const double low = out.beside(out.low, -0.06), high = out.beside(out.high, 0.06);
  out.low = low, out.high = high;
  return out;
}

}  // namespace lilytank
