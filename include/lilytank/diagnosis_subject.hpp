// What a diagnosis is of: how its report names things, and which sections it has.
#pragma once
#include <array>
#include <span>
#include <string>
#include <string_view>

namespace lilytank {

/// Wording of the comparison before and after, for the recordings that it is made on.
struct FitWording {
  std::string_view where;    ///< after "mismatch removed = 40 %"
  std::string_view section;  ///< title of the table
  std::string_view figure_caption;
};

/// A code in the files of a diagnosis and what a reader is shown instead.
struct ReportName {
  std::string_view code, text;
};

/// The differences between reports of Lilies in a tank and of point bodies, as data.
struct DiagnosisSubject {
  std::string_view bodies;                  ///< "Lilies"
  FitWording held_out;                      ///< no part of the recordings was fitted
  FitWording fitted;                        ///< the fit rests on the same recordings
  std::string_view measure;                 ///< of the comparison, above its table
  std::string_view measure_axis;            ///< the same, on the axis of its plot
  std::string_view chance;                  ///< name of the line at 1
  std::string_view groups;                  ///< head of the column of rows
  std::string_view gain;                    ///< what the log-likelihood gain is of
  std::string_view curves_of;               ///< after titles of curves: bodies that these combine
  bool eq9;                                 ///< the comparison includes Eq. 9
  bool curves_tested;                       ///< maps have z and a threshold of their own
  std::span<const ReportName> variables;    ///< of curves, where the code is not the text
  std::span<const ReportName> group_names;  ///< likewise of groups of statistics

  const FitWording& fit(bool nothing_held_out) const {
    return nothing_held_out ? fitted : held_out;
  }
};

/// The text for a code; the code itself where there is none.
inline std::string text_for(std::span<const ReportName> names, std::string_view code) {
  for (const ReportName& name : names) {
    if (name.code == code) return std::string(name.text);
  }
  return std::string(code);
}

namespace subject {

inline constexpr std::array<ReportName, 5> kTankVariables{{
    {"radius", "distance from the centre"},
    {"pair", "gap to another module"},
    {"slip", "speed through the water"},
    {"position", "position x"},
    {"turn", "rate of turning"},
}};
// The curve over "turn" of a body is the sideways force over its speed.
inline constexpr std::array<ReportName, 6> kBodyVariables{{
    {"radius", "distance from the centre"},
    {"pair", "gap to another body"},
    {"slip", "speed"},
    {"medium slip", "speed relative to the medium"},
    {"position", "position x"},
    {"turn", "speed"},
}};
inline constexpr std::array<ReportName, 13> kTankGroups{{
    {"balance", "balance of momentum"},
    {"bond", "joins and releases"},
    {"camera", "gaps at contact, across the image"},
    {"contact", "bounces"},
    {"displacement", "displacement (MSD)"},
    {"kicks", "process noise between frames"},
    {"module", "differences between modules"},
    {"neighbours", "distance of neighbours"},
    {"noise", "size and memory of gusts"},
    {"place", "place in the tank, mean flow"},
    {"spectrum", "rhythms"},
    {"turning", "turning and its memory"},
    {"velocity", "speed and its memory"},
}};
// All runs are fitted; the prediction starts from each sample and uses those coefficients.
inline constexpr FitWording kBodyFit{
    ", a quarter of a run ahead", "Prediction a quarter of a run ahead",
    "Before and after: mean square error of places a quarter of a run ahead, over the square "
    "of the measurement's noise. The coefficients are those fitted to all runs, these "
    "included."};

}  // namespace subject

/// Lilies in a tank: recordings against simulations (diagnose).
inline constexpr DiagnosisSubject kLiliesInTank{
    .bodies = "Lilies",
    .held_out = {", on held-out recordings", "Fit to the held-out recordings",
                 "Before and after, on recordings that were not used: groups of numbers that "
                 "describe the motion, each in units of what chance alone would give."},
    .fitted = {", on the fitted recordings", "Fit to the recordings (none was held out)",
               "Before and after, on recordings that the fit rests on, as none was held out: "
               "groups of numbers that describe the motion, each in units of what chance alone "
               "would give."},
    .measure =
        "Mean squared z of groups of summary statistics against simulations, before and "
        "after; 1 is expected by chance.",
    .measure_axis = "mean squared z (expected by chance: 1)",
    .chance = "chance",
    .groups = "statistics",
    .gain = "One step ahead",
    .curves_of = "",
    .eq9 = true,
    .curves_tested = true,
    .variables = subject::kTankVariables,
    .group_names = subject::kTankGroups};

/// Point bodies: predictions against positions (diagnose_bodies).
inline constexpr DiagnosisSubject kPointBodies{
    .bodies = "bodies",
    .held_out = subject::kBodyFit,
    .fitted = subject::kBodyFit,
    .measure =
        "Mean square error over that of the noise, before and after; coefficients of "
        "all runs.",
    .measure_axis = "mean square error / variance of the noise",
    .chance = "noise alone",
    .groups = "bodies",
    .gain = "Held-out runs",
    .curves_of = ", all bodies together",
    .eq9 = false,
    .curves_tested = false,
    .variables = subject::kBodyVariables,
    .group_names = {}};

}  // namespace lilytank
