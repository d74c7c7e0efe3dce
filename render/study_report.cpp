#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdio>
#include <map>

#include "html_report.hpp"
#include "statistics/undefined.hpp"
#include "study_names.hpp"
#include "text/number.hpp"
#include "text/words.hpp"
#include "yield.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kBandsUpTo = 6;  // settings; more bands hide each other

Plot time_plot(const TimeUnit& unit) {
  Plot plot;
  plot.x_label = "time (" + unit.name + ")";
  return plot;
}

void drop_bands(const StudySummary& summary, Curve& curve) {
  if (summary.settings.size() > kBandsUpTo) curve.low.clear(), curve.high.clear();
}

// Adds the curve of setting `number`. A colour means a setting in all figures of a study, so the
// places of those without a curve stay empty.
void add_of_setting(Plot& plot, std::size_t number, const SettingNames& names, Curve curve) {
  curve.name = names.names[number], curve.shade = names.shades[number];
  plot.legend_title = names.title;
  plot.curves.resize(number);
  plot.curves.push_back(std::move(curve));
}

// Of the setting with most copies at the end, or of those that have equally many.
std::string yield_sentence(const StudySummary& summary, const TimeUnit& unit) {
  const SettingSummary* most = nullptr;
  int settings = 0, equal = 0;
  for (const SettingSummary& s : summary.settings) {
    if (s.runs == 0 || std::isnan(s.copies.value)) continue;
    ++settings;
    if (most == nullptr || s.copies.value > most->copies.value) most = &s, equal = 0;
    equal += s.copies.value == most->copies.value;
  }
  if (most == nullptr) return "";
  const std::string copies =
      significant(most->copies.value, 3) + " of " + std::to_string(most->possible) + " copies";
  const std::string after =
      "After " + significant(summary.horizon / unit.seconds, 3) + " " + unit.name + ", ";
  if (settings == 1) return after + copies + " are complete on average.";
  if (equal > 1) {
    const std::string which = equal == settings ? "all" : std::to_string(equal);
    return after + which + " settings have " + copies + " on average.";
  }
  return after + most->label + " has most completed copies: " + copies + " on average.";
}

Plot mean_yield_plot(const StudySummary& summary, const SettingNames& names, const TimeUnit& unit) {
  Plot plot = time_plot(unit);
  plot.title = yield_sentence(summary, unit);
  plot.y_label = "mean copies of the target";
  int most = 1;
  for (std::size_t s = 0; s < summary.settings.size(); ++s) {
    const SettingSummary& setting = summary.settings[s];
    if (setting.runs == 0) continue;
    most = std::max(most, setting.possible);
    const CurveBand& band = setting.yield;
    Curve curve{"", divided(band.time, unit.seconds), band.mean, band.low, band.high};
    curve.steps = true;
    drop_bands(summary, curve);
    add_of_setting(plot, s, names, std::move(curve));
  }
  plot.y_low = -0.03 * most, plot.y_high = 1.05 * most;
  return plot;
}

// From (0, 1) along the steps; where nobody is left, on to the horizon.
Curve survival_curve(const Survival& survival, double horizon, const TimeUnit& unit) {
  Curve curve;
  curve.steps = true;
  const auto add = [&](double time, double value, double low, double high) {
    curve.x.push_back(time / unit.seconds), curve.y.push_back(value);
    curve.low.push_back(low), curve.high.push_back(high);
  };
  const bool events = survival.survival.back() < 1;
  add(0, 1, events ? 1 : survival.low.back(), 1);
  for (std::size_t i = 0; i < survival.time.size(); ++i) {
    // What is known before the first event is the number of runs; the band begins with the event.
    const bool before = events && survival.survival[i] >= 1;
    add(survival.time[i], survival.survival[i], before ? 1 : survival.low[i], survival.high[i]);
    if (survival.censored[i] > 0) curve.marks.push_back(survival.time[i] / unit.seconds);
  }
  if (curve.y.back() <= 0 && survival.time.back() < horizon)
    add(horizon, 0, kUndefined, kUndefined);
  return curve;
}

// Whether times differ between all settings together; empty if nothing was tested.
std::string test_sentence(const StudySummary& summary, int k) {
  for (const SurvivalTest& test : summary.survival_tests) {
    if (test.k != k || test.result.degrees == 0) continue;
    char text[60];
    std::snprintf(text, sizeof text,
                  test.result.p < 1e-4 ? " (log-rank p < 0.0001)." : " (log-rank p = %.2g).",
                  test.result.p);
    // The test of all comes before those of pairs.
    return "Times to copy " + std::to_string(k) +
           (test.result.p < 0.05 ? " differ" : " do not differ significantly") +
           " between settings" + text;
  }
  return "";
}

Plot survival_plot(const StudySummary& summary, const SettingNames& names, int k,
                   const TimeUnit& unit) {
  Plot plot = time_plot(unit);
  plot.title = test_sentence(summary, k);
  plot.y_label = k == 1 ? "fraction without a copy"
                        : "fraction with fewer than " + std::to_string(k) + " copies";
  for (std::size_t s = 0; s < summary.settings.size(); ++s) {
    for (const CopyTime& time : summary.settings[s].times) {
      if (time.k != k || time.survival.time.empty()) continue;
      Curve curve = survival_curve(time.survival, summary.horizon, unit);
      drop_bands(summary, curve);
      add_of_setting(plot, s, names, std::move(curve));
    }
  }
  plot.y_low = -0.03, plot.y_high = 1.04;
  plot.x_low = 0,
  plot.x_high = 1.015 * summary.horizon / unit.seconds;  // room for a mark at the end
  return plot;
}

// Settings with runs, by rising value of the only axis; none if that is not of numbers.
std::vector<const SettingSummary*> along_axis(const StudySummary& summary) {
  std::vector<const SettingSummary*> along;
  if (summary.axes.size() != 1 || number_axes(summary).empty()) return along;
  for (const SettingSummary& setting : summary.settings) {
    if (setting.runs > 0) along.push_back(&setting);
  }
  std::stable_sort(
      along.begin(), along.end(),
      [](const SettingSummary* a, const SettingSummary* b) { return a->values[0] < b->values[0]; });
  return along;
}

Curve mean_time_curve(const std::vector<const SettingSummary*>& along, int k, const TimeUnit& unit,
                      const ValueAxis& axis, double beside) {
  Curve curve;
  curve.name = "k = " + std::to_string(k);
  curve.markers = curve.bars = true;
  for (const SettingSummary* setting : along) {
    for (const CopyTime& time : setting->times) {
      if (time.k != k || std::isnan(time.restricted_mean.value)) continue;
      const Estimate& mean = time.restricted_mean;
      curve.x.push_back(axis.beside(setting->values[0], beside));
      curve.y.push_back(mean.value / unit.seconds);
      curve.low.push_back(mean.low / unit.seconds);
      curve.high.push_back(mean.high / unit.seconds);
    }
  }
  return curve;
}

Plot mean_time_plot(const StudySummary& summary, const std::vector<const SettingSummary*>& along,
                    const TimeUnit& unit) {
  Plot plot;
  plot.x_label = axis_label(summary.axes[0]);
  plot.y_label = "restricted mean time to copy k (" + unit.name + ")";
  const ValueAxis axis = value_axis(summary, 0);
  plot.x_low = axis.low, plot.x_high = axis.high, plot.log_x = axis.log;
  constexpr double kApart = 0.008;  // of the axis, so that bars do not cover each other
  const double middle = 0.5 * static_cast<double>(summary.copies.size() - 1);
  for (std::size_t i = 0; i < summary.copies.size(); ++i) {
    Curve curve = mean_time_curve(along, summary.copies[i], unit, axis,
                                  kApart * (static_cast<double>(i) - middle));
    if (!curve.x.empty()) plot.curves.push_back(std::move(curve));
  }
  double most = 0;
  for (const Curve& curve : plot.curves) {
    for (const double high : curve.high) most = std::max(most, high);
  }
  plot.y_low = 0, plot.y_high = 1.05 * most;
  return plot;
}

// Copies at the end over one axis, a dot a setting, in the colours of another axis if there is one.
// Dots of one value stand beside each other.
Plot copies_plot(const StudySummary& summary, std::size_t along,
                 const std::vector<std::size_t>& axes) {
  Plot plot;
  plot.x_label = axis_label(summary.axes[along]), plot.y_label = "copies at the end, mean";
  SettingNames names = shades_by(summary, along == axes[0] ? axes.back() : axes[0]);
  if (axes.size() == 1) {
    names = {"", std::vector<std::string>(summary.settings.size()),
             std::vector<double>(summary.settings.size(), 0.2)};
  }
  const ValueAxis axis = value_axis(summary, along);
  plot.x_low = axis.low, plot.x_high = axis.high, plot.log_x = axis.log;
  std::map<double, int> at, done;
  for (const SettingSummary& s : summary.settings) {
    if (s.runs > 0) ++at[s.values[along]];
  }
  int most = 1;
  for (std::size_t s = 0; s < summary.settings.size(); ++s) {
    const SettingSummary& setting = summary.settings[s];
    if (setting.runs == 0) continue;
    most = std::max(most, setting.possible);
    const double value = setting.values[along];
    const double apart = std::min(0.012, 0.1 / at[value]);  // of the axis
    const double x = axis.beside(value, apart * (done[value]++ - 0.5 * (at[value] - 1)));
    const Estimate& copies = setting.copies;
    Curve dot{"", {x}, {copies.value}, {copies.low}, {copies.high}};
    dot.markers = dot.bars = true, dot.line = false;
    add_of_setting(plot, s, names, std::move(dot));
  }
  plot.y_low = -0.03 * most, plot.y_high = 1.05 * most;
  return plot;
}

// "20 runs in each of 4 settings"
std::string runs_text(const StudySummary& summary) {
  int least = INT_MAX, most = 0, settings = 0;
  for (const SettingSummary& s : summary.settings) {
    if (s.runs == 0) continue;
    least = std::min(least, s.runs), most = std::max(most, s.runs), ++settings;
  }
  const std::string runs =
      least == most ? counted(most, "run") : std::to_string(least) + " to " + counted(most, "run");
  return settings == 1 ? runs : runs + " in each of " + counted(settings, "setting");
}

}  // namespace

std::vector<Figure> study_plots(const StudySummary& summary) {
  std::vector<Figure> figures;
  const auto add = [&](const std::string& name, const std::string& caption, const Plot& plot,
                       const std::string& band) {
    figures.push_back({name, caption, {{plot}}, {}, {}, runs_text(summary), band});
  };
  const TimeUnit unit = unit_for(summary.horizon);
  const bool any = std::any_of(summary.settings.begin(), summary.settings.end(),
                               [](const SettingSummary& s) { return s.runs > 0; });
  if (!any || summary.copies.empty()) return figures;
  const SettingNames names = names_of(summary);
  add("yield", "Mean number of completed copies over time, with its 95 % band.",
      mean_yield_plot(summary, names, unit), "95 %, bootstrap over runs");
  for (const int k : summary.copies) {
    const std::string copy = std::to_string(k);
    add("survival_" + copy,
        "Fraction of runs without copy " + copy +
            " over time (Kaplan and Meier), with its 95 % band.",
        survival_plot(summary, names, k, unit), "95 %, Kaplan and Meier");
  }
  const std::vector<const SettingSummary*> along = along_axis(summary);
  if (!along.empty()) {
    add("mean_time", "Mean time to each copy, with its 95 % interval.",
        mean_time_plot(summary, along, unit), "intervals: 95 %");
  }
  if (settings_with_runs(summary) <= kNamedUpTo) return figures;
  const std::vector<std::size_t> axes = number_axes(summary);
  for (const std::size_t axis : axes) {
    add("copies_over_" + summary.axes[axis],
        "Completed copies at the end over " + summary.axes[axis] + ", with their 95 % intervals.",
        copies_plot(summary, axis, axes), "intervals: 95 % (Student)");
  }
  return figures;
}

}  // namespace lilytank
