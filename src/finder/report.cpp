// The report of a diagnosis as a document.
#include <algorithm>
#include <cmath>

#include "lilytank/diagnosis.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

std::string digits(double value) {
  return significant(value, 3);
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return text + (unit.empty() || unit == "1" ? "" : " " + unit);
}

std::string percent(double fraction) {
  return digits(100 * fraction) + " %";
}

/// Names of the effects, alternatives included.
std::string names_of(const DiagnosisFinding& f) {
  std::string out = f.effect == "unnamed" ? "an unnamed law over " + f.variable : f.effect;
  for (const std::string& name : f.alternatives) out += " or " + name;
  return out;
}

std::string verdict_of(const Diagnosis& d) {
  const auto effects = [&] { return joined(d.findings, ", ", names_of); };
  switch (d.verdict) {
    case Verdict::complete:
      return "no discrepancy detected";
    case Verdict::measurement:
      return "the recordings are faulty: " + effects() + "; forces were not tested";
    case Verdict::undecided:
      return "a discrepancy that these data cannot attribute";
    case Verdict::insufficient:
      return "the recordings are insufficient for a diagnosis";
    default:
      return (d.findings.size() == 1 ? "omitted effect: " : "omitted effects: ") + effects();
  }
}

ReportTone tone_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::complete:
      return ReportTone::good;
    case Verdict::missing:
      return ReportTone::finding;
    case Verdict::measurement:
    case Verdict::insufficient:
      return ReportTone::fault;
    default:
      return ReportTone::neutral;
  }
}

std::string size_of(const FoundParameter& p) {
  std::string value = digits(p.value);
  if (p.low < p.high) value += " [" + digits(p.low) + ", " + digits(p.high) + "]";
  return with_unit(value, p.unit);
}

// The best of the proposed experiments.
std::string proposal_of(const Diagnosis& d) {
  const ProposedExperiment& best = d.next.front();
  return "record " + best.text() + " (next_experiment.toml): expected to distinguish " + best.pair +
         " by " + significant(best.information, 2) + " nat" +
         (best.repeats || !std::isfinite(best.relative)
              ? ""
              : ", " + significant(best.relative, 2) +
                    " times as much per minute as more of the same");
}

std::string next_step(const Diagnosis& d) {
  switch (d.verdict) {
    case Verdict::complete:
      return "longer recordings detect smaller effects; the table below lists what these detect";
    case Verdict::measurement:
      return "correct the recordings, then diagnose again";
    case Verdict::undecided:
      return d.next.empty() ? "record longer, then diagnose again" : proposal_of(d);
    case Verdict::insufficient:
      return "record " + to_record(d.shortfalls) +
             " (next_experiment.toml); a diagnosis of what is there (--uncertified) has unknown "
             "error rates";
    default:
      break;
  }
  const DiagnosisFinding& first = d.findings.front();
  if (!first.alternatives.empty()) {
    if (!d.next.empty()) return proposal_of(d);
    return "to distinguish " + names_of(first) + ": " +
           (first.split.empty() ? "a longer recording" : first.split);
  }
  return d.overlay.empty() ? "" : "simulate with the overlay missing.toml";
}

/// What the strongest residual of a null experiment stays below.
double null_threshold(const Diagnosis& d) {
  return std::max(d.effect_threshold, d.shape_threshold);
}

bool residual_remains(const Diagnosis& d) {
  return d.subject->curves_tested && d.strongest_left > std::max(null_threshold(d), d.inexact);
}

/// What to say of the residual after the findings.
std::string residual_of(const Diagnosis& d) {
  const std::string z = digits(d.strongest_left);
  if (residual_remains(d)) return z + ", which is larger than chance explains";
  if (d.strongest_left <= null_threshold(d)) return z;
  return z + ", within the errors of the findings' fingerprints (" + digits(d.inexact) + ")";
}

/// "coefficient = 0.3 1/s [0.2, 0.4]; ..."; of many bodies their distribution alone.
std::string sizes_of(const DiagnosisFinding& f) {
  const auto is_distribution = [](const FoundParameter& p) {
    return p.path.ends_with(".mean") || p.path.ends_with(".between");
  };
  std::vector<FoundParameter> shown = f.parameters;
  if (std::ranges::any_of(shown, is_distribution))
    std::erase_if(shown, std::not_fn(is_distribution));
  return joined(shown, "; ", [](const FoundParameter& p) { return p.name + " = " + size_of(p); });
}

ReportCard card_of(const Diagnosis& d) {
  ReportCard card;
  card.tone = tone_of(d.verdict), card.verdict = verdict_of(d);
  if (d.verdict == Verdict::insufficient) {
    for (const Shortfall& s : d.shortfalls) card.facts.emplace_back("requirement", s.what);
  }
  for (const DiagnosisFinding& f : d.findings) {
    const std::string of = d.findings.size() > 1 ? " of " + f.effect : "";
    if (!f.text.empty()) card.facts.emplace_back("where" + of, f.text);
    if (!f.parameters.empty()) card.facts.emplace_back("size" + of, sizes_of(f));
  }
  const double removed = d.removed();
  if (d.verdict == Verdict::missing && !std::isnan(removed)) {
    const std::string where(d.subject->fit(d.nothing_held_out).where);
    card.facts.emplace_back("mismatch removed", percent(removed) + where);
    if (residual_remains(d)) {
      card.facts.emplace_back("remains", "a residual of z " + digits(d.strongest_left) +
                                             " that no further effect explains; null experiments " +
                                             "reach " + digits(null_threshold(d)));
    }
  }
  if (const std::string next = next_step(d); !next.empty()) card.facts.emplace_back("next", next);
  return card;
}

ReportSection section_of(const DiagnosisFinding& f, bool ranked) {
  ReportSection section;
  // Faults that checks find have no z.
  section.title = f.effect + "  (" + (f.z > 0 ? "z " + digits(f.z) + ", " : "") + "depends on " +
                  f.variable + ")";
  if (!f.equation.empty()) section.above.push_back(f.equation);
  if (!f.text.empty()) section.above.push_back(f.text);
  if (!f.parameters.empty()) section.table.head = {"parameter", "value", "95 % from", "to", "unit"};
  for (const FoundParameter& p : f.parameters) {
    const bool bounded = p.low < p.high;
    section.table.rows.push_back({p.name, digits(p.value), bounded ? digits(p.low) : "-",
                                  bounded ? digits(p.high) : "-", p.unit == "1" ? "" : p.unit});
  }
  if (!f.alternatives.empty()) {
    section.below.push_back(
        "These data do not distinguish it from " + joined(f.alternatives, ", ") +
        (ranked ? "."
                : ". What would: " + (f.split.empty() ? "a longer recording" : f.split) + "."));
  }
  return section;
}

ReportSection next_section(const Diagnosis& d) {
  ReportSection section;
  section.title = "Next experiment";
  section.above = {
      "Expected log-likelihood ratio of the pair of effects that the experiment distinguishes "
      "least; "
      "information per minute is relative to more of the same recordings."};
  section.table.head = {"experiment", "min", "nat", "pair", "per minute"};
  for (const ProposedExperiment& one : d.next) {
    section.table.rows.push_back(
        {one.text(), significant(one.all_minutes(), 2), significant(one.information, 2), one.pair,
         std::isfinite(one.relative) ? significant(one.relative, 2) : "-"});
  }
  return section;
}

ReportSection fit_section(const Diagnosis& d) {
  const DiagnosisSubject& of = *d.subject;
  ReportSection section;
  section.title = of.fit(d.nothing_held_out).section;
  section.above = {std::string(of.measure)};
  section.table.head = {std::string(of.groups), "before", "after", "fraction removed"};
  for (const GroupFit& g : d.held_out) {
    section.table.rows.push_back({text_for(of.group_names, g.group), digits(g.before),
                                  digits(g.after), g.clear() ? percent(g.removed()) : "-"});
  }
  if (of.eq9) {
    section.below.push_back("Eq. 9: " + digits(d.msd_before) + " before, " + digits(d.msd_after) +
                            " after, floor " + digits(d.msd_floor) + " m^2; fraction removed " +
                            percent(d.msd_removed) + " [" + digits(100 * d.msd_low) + ", " +
                            digits(100 * d.msd_high) + "]");
  }
  const DiagnosisFinding& f = d.findings.front();
  if (std::isnan(f.gain)) return section;
  section.below.push_back(std::string(of.gain) + ": log-likelihood gain " + digits(f.gain) +
                          " nat [" + digits(f.gain_low) + ", " + digits(f.gain_high) + "]");
  return section;
}

ReportSection parameters_section(const Diagnosis& d) {
  ReportSection section;
  const bool alone = d.findings.empty();
  section.title =
      alone ? "Baseline parameters" : "Baseline parameters, alone and with the findings";
  section.table.head = {"parameter", "unit", "value", "95 % from", "to"};
  if (!alone) {
    section.table.head = {"parameter", "unit", "alone", "with findings", "95 % from", "to"};
  }
  for (const MovedParameter& p : d.parameters) {
    std::vector<std::string> row{p.path, p.unit == "1" ? "" : p.unit, digits(p.with_effects),
                                 std::isnan(p.low) ? "-" : digits(p.low),
                                 std::isnan(p.high) ? "-" : digits(p.high)};
    if (!alone) row.insert(row.begin() + 2, digits(p.baseline));
    section.table.rows.push_back(std::move(row));
  }
  return section;
}

/// Where curves are tested, effects, force laws and all statistics share the false positives.
ReportSection ranking_section(const Diagnosis& d) {
  ReportSection section;
  section.title = "Strongest effects, each tested alone";
  section.detail = true;
  const std::string share = percent(d.false_alarms) + " of null experiments ";
  if (d.subject->curves_tested) {
    section.above.push_back(
        share + "have an effect beyond z " + digits(d.effect_threshold) +
        ", a force law beyond z " + digits(d.shape_threshold) +
        ", too large a residual, or too clear a place; residual after the findings: z " +
        residual_of(d));
  } else {
    section.above.push_back(share + "exceed z " + digits(d.effect_threshold));
  }
  section.table.head = {"effect", "z", "with"};
  constexpr std::size_t kShown = 8;
  for (std::size_t i = 0; i < d.ranking.size() && i < kShown; ++i) {
    section.table.rows.push_back(
        {d.ranking[i].effect, digits(d.ranking[i].z), d.ranking[i].variant});
  }
  return section;
}

ReportSection detectable_section(const Diagnosis& d) {
  ReportSection section;
  section.title = "Smallest detectable effects";
  section.detail = d.verdict != Verdict::complete;
  section.above = {
      "Detected in half of all cases, along the axis and at the range that show least."};
  section.table.head = {"effect", "parameter", "smallest", "unit"};
  for (const Detectable& one : d.detectable) {
    const bool seen = std::isfinite(one.smallest);
    section.table.rows.push_back({one.effect, one.parameter(),
                                  (seen ? "" : "> ") + digits(seen ? one.smallest : one.tried),
                                  one.unit});
  }
  return section;
}

}  // namespace

ReportDocument diagnosis_report(const Diagnosis& d) {
  ReportDocument report;
  report.title = "Diagnosis of " + d.name;
  report.subtitle = counted(d.recordings, "recording") + " of up to " + std::to_string(d.modules) +
                    " " + std::string(d.subject->bodies) + ", " + digits(d.seconds) +
                    " s in all; verdict \"" + name_of(d.verdict) + "\"";
  report.card = card_of(d);
  report.warnings = d.warnings;
  for (const DiagnosisFinding& f : d.findings)
    report.sections.push_back(section_of(f, !d.next.empty()));
  if (d.next.size() > 1) report.sections.push_back(next_section(d));
  if (!d.held_out.empty() && !d.findings.empty()) report.sections.push_back(fit_section(d));
  if (!d.parameters.empty()) report.sections.push_back(parameters_section(d));
  if (!d.ranking.empty()) {
    report.sections.push_back(ranking_section(d));
    report.sections.push_back(detectable_section(d));
  }
  if (!d.checks.empty()) {
    report.sections.push_back({"Checks of the recordings", d.checks, {}, {}, true});
  }
  return report;
}

std::string diagnosis_text(const Diagnosis& d) {
  return report_text(diagnosis_report(d));
}

}  // namespace lilytank
