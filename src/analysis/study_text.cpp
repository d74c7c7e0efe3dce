#include <algorithm>
#include <cmath>

#include "analysis/text_table.hpp"
#include "lilytank/study_summary.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

std::string counted(std::int64_t n, const std::string& one) {
  return std::to_string(n) + " " + one + (n == 1 ? "" : "s");
}

// "0.5" for 0.5 h, without digits that say nothing.
std::string duration_text(double seconds, const TimeScale& unit) {
  return without_rounding(std::round(seconds / unit.seconds * 1e4) / 1e4) + " " + unit.name;
}

std::string head_text(const StudySummary& s, const TimeScale& unit) {
  std::int64_t runs = 0, diverged = 0, stopped = 0, illegal = 0;
  for (const SettingSummary& setting : s.settings) {
    runs += setting.runs, diverged += setting.diverged, stopped += setting.stopped;
    illegal += setting.illegal;
  }
  std::string out = "study " + s.name + ": " +
                    counted(static_cast<std::int64_t>(s.settings.size()), "setting") + ", " +
                    counted(runs + diverged + stopped, "run") + " to " +
                    duration_text(s.horizon, unit) + "\n";
  if (!s.axes.empty()) {
    out += "axes: ";
    for (std::size_t i = 0; i < s.axes.size(); ++i) out += (i > 0 ? ", " : "") + s.axes[i];
    out += "\n";
  }
  out += "diverged: " + std::to_string(diverged);
  if (diverged > 0) out += ", counted and left out of everything below";
  out += "\n";
  if (stopped > 0) out += "stopped early: " + std::to_string(stopped) + ", left out as well\n";
  out += "illegal assemblies: " + std::to_string(illegal) + "\n";
  return out + "In brackets: 95 % intervals.\n";
}

std::string settings_text(const StudySummary& s) {
  TextTable table({"no", "setting", "runs", "diverged", "copies at end", "of", "full yield",
                   "copies per hour", "illegal"});
  for (std::size_t i = 0; i < s.settings.size(); ++i) {
    const SettingSummary& setting = s.settings[i];
    const bool target = setting.possible > 0;
    Estimate per_hour = setting.rate;
    for (double* v : {&per_hour.value, &per_hour.low, &per_hour.high}) *v *= 3600;
    table.add({std::to_string(i), setting.label, std::to_string(setting.runs),
               std::to_string(setting.diverged), with_interval(setting.copies, 1, 2),
               std::to_string(setting.possible),
               target ? with_interval(setting.full_yield, 1, 2) : "-",
               target ? with_interval(per_hour) : "-", std::to_string(setting.illegal)});
  }
  return "\nSettings. Full yield: share of runs that had all possible copies, Wilson. Rate: up to "
         "the\nend or to full yield, Garwood; it takes copies to come at a steady rate.\n" +
         table.text();
}

std::string times_text(const StudySummary& s, const TimeScale& unit) {
  TextTable table({"copy", "no", "setting", "reached", "share", "mean time (" + unit.name + ")"});
  for (const int k : s.copies) {
    for (std::size_t i = 0; i < s.settings.size(); ++i) {
      for (const CopyTime& t : s.settings[i].times) {
        if (t.k != k || t.survival.time.empty()) continue;
        std::int64_t reached = 0;
        for (const std::int64_t events : t.survival.events) reached += events;
        table.add({std::to_string(k), std::to_string(i), s.settings[i].label,
                   std::to_string(reached) + "/" + std::to_string(t.survival.at_risk[0]),
                   with_interval(t.reached, 1, 2), with_interval(t.restricted_mean, unit.seconds)});
      }
    }
  }
  if (table.empty()) return "";
  return "\nTime to the k-th copy: mean of min(time, " + duration_text(s.restricted_to, unit) +
         ") from Kaplan and Meier's curve.\n" + table.text();
}

std::string pair_name(int a, int b, const char* between) {
  return a < 0 ? "all" : std::to_string(a) + between + std::to_string(b);
}

std::string against_text(const StudySummary& s) {
  return s.all_pairs ? "all pairs of settings" : "each setting against setting 0";
}

std::string survival_tests_text(const StudySummary& s) {
  TextTable table({"copy", "settings", "chi-squared", "degrees", "p", "p (Holm)"});
  for (const SurvivalTest& t : s.survival_tests) {
    const bool told = t.result.degrees > 0;
    const auto shown = [&](const std::string& text) { return told ? text : "-"; };
    table.add({std::to_string(t.k), pair_name(t.a, t.b, ", "), shown(fixed(t.result.statistic, 2)),
               shown(fixed(t.result.degrees, 0)), shown(p_text(t.result.p)),
               shown(p_text(t.adjusted_p))});
  }
  if (table.empty()) return "";
  return "\nLog-rank test of the time to the k-th copy, " + against_text(s) + ".\n" + table.text();
}

std::string pair_tests_text(const StudySummary& s, const TimeScale& unit) {
  TextTable table({"quantity", "settings", "pairs", "difference", "p", "p (Holm)", "saved"});
  bool single = false;
  for (const PairTest& t : s.pair_tests) {
    single = single || t.pairs < 2;
    const auto shown = [&](const std::string& text) { return t.reached ? text : "-"; };
    table.add({t.k == 0 ? "copies at end"
                        : "time to copy " + std::to_string(t.k) + " (" + unit.name + ")",
               pair_name(t.a, t.b, " - "), std::to_string(t.pairs),
               shown(with_interval(t.result.difference, t.k == 0 ? 1 : unit.seconds)),
               shown(p_text(t.result.p)), shown(p_text(t.adjusted_p)),
               shown(t.pairs < 2 ? "-" : fixed(t.result.saving, 2))});
  }
  if (table.empty()) return "";
  return "\nDifferences of runs that share a seed, Student, " + against_text(s) +
         ".\nSaved: the variance without sharing over the variance with it. -: no run came so "
         "far.\n" +
         (single ? "One pair cannot tell: a test takes two pairs or more.\n" : "") + table.text();
}

}  // namespace

std::string study_text(const StudySummary& summary) {
  const TimeScale unit = time_scale(summary.horizon);
  return head_text(summary, unit) + settings_text(summary) + times_text(summary, unit) +
         survival_tests_text(summary) + pair_tests_text(summary, unit);
}

}  // namespace lilytank
