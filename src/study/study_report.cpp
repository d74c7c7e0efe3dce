#include <algorithm>
#include <cmath>

#include "lilytank/study_summary.hpp"
#include "statistics/text_table.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

// "0.5" for 0.5 h, without digits that say nothing.
std::string duration_text(double seconds, const TimeScale& unit) {
  return without_rounding(std::round(seconds / unit.seconds * 1e4) / 1e4) + " " + unit.name;
}

/// The setting with the largest value of an estimate; nothing where none has one.
template <class Get>
const SettingSummary* best_of(const StudySummary& s, const Get& get) {
  const SettingSummary* best = nullptr;
  for (const SettingSummary& setting : s.settings) {
    if (setting.runs == 0 || setting.possible == 0 || std::isnan(get(setting).value)) continue;
    if (best == nullptr || get(setting).value > get(*best).value) best = &setting;
  }
  return best;
}

ReportCard card_of(const StudySummary& s, const TimeScale& unit) {
  std::int64_t runs = 0, diverged = 0, illegal = 0;
  for (const SettingSummary& setting : s.settings) {
    runs += setting.runs, diverged += setting.diverged, illegal += setting.illegal;
  }
  ReportCard card;
  card.tone = illegal > 0 ? ReportTone::fault : ReportTone::good;
  card.verdict = counted(static_cast<std::int64_t>(s.settings.size()), "setting") + ", " +
                 counted(runs + diverged, "run") + " to " + duration_text(s.horizon, unit);
  if (!s.axes.empty()) {
    std::string axes;
    for (const std::string& axis : s.axes) axes += (axes.empty() ? "" : ", ") + axis;
    card.facts.emplace_back("axes", axes);
  }
  const auto fact = [&](const std::string& name, const auto& get, double scale,
                        const std::string& of_unit) {
    const SettingSummary* best = best_of(s, get);
    if (best == nullptr) return;
    Estimate value = get(*best);
    for (double* v : {&value.value, &value.low, &value.high}) *v *= scale;
    card.facts.emplace_back(name, with_interval(value, 1, 3) + of_unit +
                                      (s.settings.size() > 1 ? ", " + best->label : ""));
  };
  fact(
      "highest full yield", [](const SettingSummary& of) { return of.full_yield; }, 1, "");
  fact(
      "highest rate", [](const SettingSummary& of) { return of.rate; }, 3600, " copies per hour");
  card.facts.emplace_back("diverged",
                          std::to_string(diverged) + (diverged > 0 ? ", excluded below" : ""));
  card.facts.emplace_back("illegal assemblies", std::to_string(illegal));
  return card;
}

ReportSection settings_section(const StudySummary& s) {
  ReportSection section;
  section.title = "Settings";
  section.above = {
      "In brackets: 95 % intervals. Full yield: fraction of runs with all possible copies "
      "(Wilson). Rate: up to the end or to full yield (Garwood); it assumes copies at a "
      "constant rate."};
  section.table.head = {"no",         "setting",         "runs",
                        "diverged",   "copies at end",   "of",
                        "full yield", "copies per hour", "illegal"};
  for (std::size_t i = 0; i < s.settings.size(); ++i) {
    const SettingSummary& setting = s.settings[i];
    const bool target = setting.possible > 0;
    Estimate per_hour = setting.rate;
    for (double* v : {&per_hour.value, &per_hour.low, &per_hour.high}) *v *= 3600;
    section.table.rows.push_back(
        {std::to_string(i), setting.label, std::to_string(setting.runs),
         std::to_string(setting.diverged), with_interval(setting.copies, 1, 2),
         std::to_string(setting.possible), target ? with_interval(setting.full_yield, 1, 2) : "-",
         target ? with_interval(per_hour) : "-", std::to_string(setting.illegal)});
  }
  return section;
}

ReportSection times_section(const StudySummary& s, const TimeScale& unit) {
  ReportSection section;
  section.title = "Time to the k-th copy";
  section.above = {"Mean of min(time, " + duration_text(s.restricted_to, unit) +
                   ") from the estimate of Kaplan and Meier."};
  section.table.head = {"copy",    "no",       "setting",
                        "reached", "fraction", "mean time (" + unit.name + ")"};
  for (const int k : s.copies) {
    for (std::size_t i = 0; i < s.settings.size(); ++i) {
      for (const CopyTime& t : s.settings[i].times) {
        if (t.k != k || t.survival.time.empty()) continue;
        std::int64_t reached = 0;
        for (const std::int64_t events : t.survival.events) reached += events;
        section.table.rows.push_back(
            {std::to_string(k), std::to_string(i), s.settings[i].label,
             std::to_string(reached) + "/" + std::to_string(t.survival.at_risk[0]),
             with_interval(t.reached, 1, 2), with_interval(t.restricted_mean, unit.seconds)});
      }
    }
  }
  return section;
}

std::string pair_name(int a, int b, const char* between) {
  return a < 0 ? "all" : std::to_string(a) + between + std::to_string(b);
}

std::string against_text(const StudySummary& s) {
  return s.all_pairs ? "all pairs of settings" : "each setting against setting 0";
}

ReportSection survival_tests_section(const StudySummary& s) {
  ReportSection section;
  section.title = "Log-rank tests of the time to the k-th copy, " + against_text(s);
  section.table.head = {"copy", "settings", "chi-squared", "degrees", "p", "p (Holm)"};
  for (const SurvivalTest& t : s.survival_tests) {
    const bool known = t.result.degrees > 0;
    const auto shown = [&](const std::string& text) { return known ? text : "-"; };
    section.table.rows.push_back({std::to_string(t.k), pair_name(t.a, t.b, ", "),
                                  shown(fixed(t.result.statistic, 2)),
                                  shown(fixed(t.result.degrees, 0)), shown(p_text(t.result.p)),
                                  shown(p_text(t.adjusted_p))});
  }
  return section;
}

ReportSection pair_tests_section(const StudySummary& s, const TimeScale& unit) {
  ReportSection section;
  section.title = "Differences of runs with the same seed (Student), " + against_text(s);
  section.above = {
      "Saved: the variance without common seeds over the variance with them. -: no run "
      "reached this copy."};
  section.table.head = {"quantity", "settings", "pairs", "difference", "p", "p (Holm)", "saved"};
  bool single = false;
  for (const PairTest& t : s.pair_tests) {
    single = single || t.pairs < 2;
    const auto shown = [&](const std::string& text) { return t.reached ? text : "-"; };
    section.table.rows.push_back(
        {t.k == 0 ? "copies at end"
                  : "time to copy " + std::to_string(t.k) + " (" + unit.name + ")",
         pair_name(t.a, t.b, " - "), std::to_string(t.pairs),
         shown(with_interval(t.result.difference, t.k == 0 ? 1 : unit.seconds)),
         shown(p_text(t.result.p)), shown(p_text(t.adjusted_p)),
         shown(t.pairs < 2 ? "-" : fixed(t.result.saving, 2))});
  }
  if (single) section.above.push_back("One pair is no test: the test needs two pairs or more.");
  return section;
}

}  // namespace

ReportDocument study_report(const StudySummary& summary) {
  const TimeScale unit = time_scale(summary.horizon);
  ReportDocument report;
  report.title = "Study " + summary.name;
  report.card = card_of(summary, unit);
  report.sections.push_back(settings_section(summary));
  for (ReportSection section : {times_section(summary, unit), survival_tests_section(summary),
                                pair_tests_section(summary, unit)}) {
    if (!section.table.rows.empty()) report.sections.push_back(std::move(section));
  }
  return report;
}

}  // namespace lilytank
