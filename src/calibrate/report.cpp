// The report of a calibration as a document.
#include <algorithm>
#include <cmath>

#include "lilytank/calibration.hpp"
#include "statistics/text_table.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kWorst = 5;  // statistics that are listed where the model does not fit

std::string digits(double value) {
  return std::isnan(value) ? "-" : significant(value, 4);
}

std::string bounded(const CalibratedParameter& p) {
  const std::string unit = p.parameter.unit == "1" ? "" : " " + p.parameter.unit;
  return digits(p.estimate) + " [" + digits(p.low) + ", " + digits(p.high) + "]" + unit;
}

ReportCard card_of(const CalibrationResult& c) {
  constexpr double kSignificant = 0.05;
  ReportCard card;
  const bool fits = !(c.misfit_p < kSignificant);
  const std::vector<Shortfall>& shortfalls = c.coverage.flow;
  card.tone = fits ? ReportTone::good : ReportTone::fault;
  card.verdict = std::string("the calibrated model ") +
                 (fits ? "fits the recordings" : "does not fit the recordings") +
                 (std::isnan(c.misfit_p) ? "" : " (p = " + p_text(c.misfit_p) + ")");
  if (!shortfalls.empty()) {
    card.tone = ReportTone::fault;
    card.verdict = "insufficient recordings of balls: the estimates are not reliable";
    for (const Shortfall& s : shortfalls) card.facts.emplace_back("requirement", s.what);
  }
  for (const CalibratedParameter& p : c.parameters) {
    if (!p.parameter.nuisance) card.facts.emplace_back(p.parameter.path, bounded(p));
  }
  for (const MsdFit& m : c.msd) {
    card.facts.emplace_back("Eq. 9, " + m.recordings,
                            digits(m.before) + " m^2 before, " + digits(m.after) +
                                " m^2 after, noise floor " + digits(m.floor) + " m^2");
  }
  if (!shortfalls.empty()) {
    card.facts.emplace_back("next", "record " + to_record(shortfalls));
    return card;
  }
  card.facts.emplace_back("next", fits ? "simulate with the overlay calibrated.toml"
                                       : "lilytank diagnose tests which effect the model omits");
  return card;
}

ReportSection parameters_section(const CalibrationResult& c) {
  ReportSection section;
  section.title = "Parameters";
  section.table.head = {"parameter", "unit", "before", "search", "estimate", "95 % from", "to"};
  for (const CalibratedParameter& p : c.parameters) {
    section.table.rows.push_back(
        {p.parameter.path, p.parameter.unit == "1" ? "" : p.parameter.unit, digits(p.start),
         p.parameter.nuisance || c.search_name == "none" ? "-" : digits(p.searched),
         digits(p.estimate), digits(p.low), digits(p.high)});
  }
  return section;
}

ReportSection msd_section(const CalibrationResult& c) {
  ReportSection section;
  section.title = "Mean squared displacement, Eq. 9 (m^2)";
  section.table.head = {"recordings",  "pieces",        "before",          "after",
                        "noise floor", "after / floor", "two simulations", "p"};
  for (const MsdFit& m : c.msd) {
    section.table.rows.push_back(
        {m.recordings, std::to_string(m.pieces) + " of " + digits(m.seconds) + " s",
         digits(m.before), digits(m.after), digits(m.floor), fixed(m.after / m.floor, 2),
         digits(m.equals), p_text(m.equals_p)});
  }
  return section;
}

/// The misfit, and the summary statistics that contribute most where the model does not fit.
ReportSection misfit_section(const CalibrationResult& c) {
  ReportSection section;
  section.title = "Goodness of fit";
  section.above = {"Misfit " + digits(c.misfit) + "; a larger one has probability " +
                   p_text(c.misfit_p) + " if the model is true."};
  std::vector<const ComparedNumber*> worst;
  for (const ComparedNumber& n : c.numbers) worst.push_back(&n);
  std::stable_sort(worst.begin(), worst.end(), [](const auto* a, const auto* b) {
    return std::fabs(a->z()) > std::fabs(b->z());
  });
  if (c.misfit_p >= 0.05 || worst.empty()) return section;
  section.table.head = {"group", "summary statistic", "z"};
  for (std::size_t i = 0; i < std::min(kWorst, worst.size()); ++i) {
    section.table.rows.push_back(
        {worst[i]->entry.group, worst[i]->entry.name, fixed(worst[i]->z(), 1)});
  }
  return section;
}

}  // namespace

ReportDocument calibration_report(const CalibrationResult& c) {
  ReportDocument report;
  report.title = "Calibration of " + c.name;
  report.subtitle = counted(c.recordings, "recording") + " of up to " + std::to_string(c.bodies) +
                    (c.body == BodyKind::lily ? " Lilies, " : " balls, ") + digits(c.seconds) +
                    " s in all; objective " + c.objective + ", flow " + c.flow + ", step " +
                    digits(1000 * c.dt) + " ms; " + std::to_string(c.rounds) +
                    " response surfaces, " + std::to_string(c.simulations) +
                    " simulated experiments";
  report.card = card_of(c);
  report.sections.push_back(parameters_section(c));
  if (!c.msd.empty()) report.sections.push_back(msd_section(c));
  report.sections.push_back(misfit_section(c));
  report.warnings = c.warnings;
  return report;
}

}  // namespace lilytank
