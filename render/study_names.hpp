// Names and colours that distinguish the settings of a study in its plots.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "lilytank/study_summary.hpp"

namespace lilytank {

/// Names and colours of curves, one a setting.
struct SettingNames {
  std::string title;               ///< of the legend; may be empty
  std::vector<std::string> names;  ///< empty: not in the legend
  std::vector<double> shades;      ///< as Curve::shade
};

/// Beyond so many settings a legend is no help: colours then show an axis' value.
inline constexpr std::size_t kNamedUpTo = 12;

/// How many settings have finished runs.
std::size_t settings_with_runs(const StudySummary& summary);

/// Of curves over time. Few settings are named by what they differ in: of one axis as its labels
/// say ("count=10"), of more by values alone ("10, 60 %"), under a title that has their keys. Many
/// have colours by the first axis of numbers, and some of its values in the legend; without such
/// an axis their whole labels.
SettingNames names_of(const StudySummary& summary);

/// Colours by the values of one axis of numbers, five of them at most with a name.
SettingNames shades_by(const StudySummary& summary, std::size_t axis);

/// The axes whose values are numbers, not words, and not all the same. Positions of words are no
/// numbers: a label such as "flow.pump_power=80 %" shows one.
std::vector<std::size_t> number_axes(const StudySummary& summary);

/// "flow.pump_power (%)": an axis' values are in the unit of its key.
std::string axis_label(const std::string& path);

/// A horizontal axis with room at its ends, on which points stand apart by a little.
struct ValueAxis {
  double low = 0, high = 1;
  bool log = false;  ///< values over more than one and a half decades would crowd at the left
  /// The place that is `share` of the axis' length to the right of a value.
  double beside(double value, double share) const;
};
/// Over the values of an axis of numbers, of the settings that have runs.
ValueAxis value_axis(const StudySummary& summary, std::size_t axis);

}  // namespace lilytank
