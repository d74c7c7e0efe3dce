// The report of a diagnosis as text.
#include <cmath>

#include "analysis/text_table.hpp"
#include "lilytank/diagnosis.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

std::string digits(double value) {
  return significant(value, 3);
}

std::string headline(const Diagnosis& d) {
  switch (d.verdict) {
    case Verdict::complete:
      return "nothing is missing that these data could show";
    case Verdict::measurement:
      return "the recordings are at fault; no force was looked for";
    case Verdict::undecided:
      return "something differs, and these data cannot say what";
    default:
      return d.findings.size() == 1 ? "one effect is missing"
                                    : std::to_string(d.findings.size()) + " effects are missing";
  }
}

void tell(const DiagnosisFinding& f, std::string& out) {
  // Faults that checks find have no z.
  out += "\n" + f.effect + "  (" + (f.z > 0 ? "z " + digits(f.z) + ", " : "") + "depends on " +
         f.variable + ")\n";
  if (!f.equation.empty()) out += "  " + f.equation + "\n";
  if (!f.text.empty()) out += "  " + f.text + "\n";
  for (const FoundParameter& p : f.parameters) {
    out += "  " + p.name + " = " + digits(p.value);
    if (p.low < p.high) out += "  [" + digits(p.low) + ", " + digits(p.high) + "]";
    out += (p.unit.empty() || p.unit == "1" ? "" : " " + p.unit) + "\n";
  }
  if (!f.alternatives.empty()) {
    out += "  these data cannot tell it from:";
    for (const std::string& name : f.alternatives) out += " " + name;
    out += "; what would: " + (f.split.empty() ? "a longer recording" : f.split) + "\n";
  }
}

void tell_fit(const Diagnosis& d, std::string& out) {
  out += d.nothing_held_out ? "\nThe recordings that were fitted (no other was held out)"
                            : "\nRecordings that had no part in this";
  out += ", against simulations before and after: mean square of deviations, 1 is chance\n";
  TextTable table({"numbers", "before", "after", "share removed"});
  for (const GroupFit& g : d.held_out) {
    table.add({g.group, digits(g.before), digits(g.after),
               g.clear() ? digits(100 * g.removed()) + " %" : "-"});
  }
  out += table.text();
  out += "  Eq. 9: " + digits(d.msd_before) + " before, " + digits(d.msd_after) + " after, floor " +
         digits(d.msd_floor) + " m^2; share removed " + digits(100 * d.msd_removed) + " % [" +
         digits(100 * d.msd_low) + ", " + digits(100 * d.msd_high) + "]\n";
  const DiagnosisFinding& f = d.findings.front();
  out += "  one step ahead: gain of " + digits(f.gain) + " nat [" + digits(f.gain_low) + ", " +
         digits(f.gain_high) + "]\n";
}

// Of bodies that are not a tank's: how far a quarter of a run ahead they are from where they should
// be, by coefficients of all runs.
void tell_far(const Diagnosis& d, std::string& out) {
  out += "\nA quarter of a run ahead, before and after: mean squares by those of the noise\n";
  TextTable table({"bodies", "before", "after", "share removed"});
  for (const GroupFit& g : d.held_out) {
    table.add({g.group, digits(g.before), digits(g.after),
               g.clear() ? digits(100 * g.removed()) + " %" : "-"});
  }
  out += table.text();
  const DiagnosisFinding& f = d.findings.front();
  out += "  runs that were left out: gain of " + digits(f.gain) + " nat [" + digits(f.gain_low) +
         ", " + digits(f.gain_high) + "]\n";
}

// Of a tank, false alarms are shared by effects, curves and all numbers together.
void tell_thresholds(const Diagnosis& d, std::string& out) {
  const std::string share = digits(100 * d.false_alarms) + " % of complete experiments ";
  out += "\nStrongest effects, each alone (z; ";
  if (d.tank) {
    out += share + "have an effect beyond " + digits(d.effect_threshold) + ", a curve beyond " +
           digits(d.shape_threshold) +
           " or too much in all); left after the findings: " + digits(d.strongest_left) + "\n";
  } else {
    out += share + "exceed " + digits(d.effect_threshold) + ")\n";
  }
}

}  // namespace

std::string diagnosis_text(const Diagnosis& d) {
  std::string out =
      "diagnosis of " + d.name + ": " + name_of(d.verdict) + ", " + headline(d) + "\n";
  out += std::to_string(d.recordings) + (d.recordings == 1 ? " recording" : " recordings") +
         " of up to " + std::to_string(d.modules) + (d.tank ? " Lilies, " : " bodies, ") +
         digits(d.seconds) + " s in all\n";
  if (!d.checks.empty()) out += "\nWhat the checks of the recordings found\n";
  for (const std::string& check : d.checks) out += "  " + check + "\n";
  for (const DiagnosisFinding& f : d.findings) tell(f, out);
  if (!d.held_out.empty() && !d.findings.empty()) {
    d.tank ? tell_fit(d, out) : tell_far(d, out);
  }
  if (!d.parameters.empty()) {
    const bool alone = d.findings.empty();
    out += alone ? "\nThe baseline's parameters\n"
                 : "\nThe baseline's parameters, alone and beside what was found\n";
    std::vector<std::string> head{"parameter", "unit", "value", "95 % from", "to"};
    if (!alone) head[2] = "beside it", head.insert(head.begin() + 2, "alone");
    TextTable table(head);
    for (const MovedParameter& p : d.parameters) {
      std::vector<std::string> row{p.path, p.unit == "1" ? "" : p.unit, digits(p.with_effects),
                                   std::isnan(p.low) ? "-" : digits(p.low),
                                   std::isnan(p.high) ? "-" : digits(p.high)};
      if (!alone) row.insert(row.begin() + 2, digits(p.baseline));
      table.add(row);
    }
    out += table.text();
  }
  if (!d.ranking.empty()) {
    tell_thresholds(d, out);
    TextTable table({"effect", "z", "with"});
    for (std::size_t i = 0; i < d.ranking.size() && i < 8; ++i) {
      table.add({d.ranking[i].effect, digits(d.ranking[i].z), d.ranking[i].variant});
    }
    out += table.text();
    out +=
        "\nSmallest effects that would have been seen in half of all cases, along the axis and at "
        "the range that show least\n";
    TextTable least({"effect", "parameter", "smallest", "unit"});
    for (const Detectable& one : d.detectable) {
      const bool seen = std::isfinite(one.smallest);
      least.add({one.effect, one.parameter(),
                 (seen ? "" : "> ") + digits(seen ? one.smallest : one.tried), one.unit});
    }
    out += least.text();
  }
  for (const std::string& w : d.warnings) out += "warning: " + w + "\n";
  return out;
}

}  // namespace lilytank
