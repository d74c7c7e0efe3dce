// What blinded experiments say of a diagnosis, as a document and as figures.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "lilytank/proof.hpp"
#include "lilytank/statistics.hpp"
#include "proof/rate_text.hpp"
#include "statistics/text_table.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {

bool ProofFinding::names(const std::string& of) const {
  return effect == of ||
         std::find(alternatives.begin(), alternatives.end(), of) != alternatives.end();
}

bool ProofInterval::of_effect(const std::vector<std::string>& effects) const {
  return path.starts_with("forces.empirical_force.") || path.starts_with("contact.") ||
         path.starts_with("control.") ||
         std::any_of(effects.begin(), effects.end(),
                     [&](const std::string& of) { return path.starts_with("forces." + of + "."); });
}

bool ProofWorld::right() const {
  if (kind == "null") return verdict == Verdict::complete;
  if (verdict != Verdict::missing && verdict != Verdict::measurement) return false;
  const ProofFinding& first = findings.front();
  if (kind == "unnamed") return first.effect == "unnamed" && first.variable == effects[0];
  if (kind == "named") return first.names(effects[0]);
  return std::all_of(effects.begin(), effects.end(), [&](const std::string& own) {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const ProofFinding& f) { return f.names(own); });
  });
}

bool ProofWorld::wrong_name() const {
  return std::any_of(findings.begin(), findings.end(), [&](const ProofFinding& f) {
    return f.effect != "unnamed" &&
           std::none_of(effects.begin(), effects.end(),
                        [&](const std::string& own) { return f.names(own); });
  });
}

namespace {

std::string key_of(const ProofWorld& w) {
  if (w.kind == "null") return "(nothing)";
  return (w.kind == "unnamed" ? "odd " : "") + joined(w.effects, " + ");
}

std::string said_of(const ProofWorld& w) {
  std::vector<std::string> names;
  for (const ProofFinding& f : w.findings) {
    std::vector<std::string> group{f.effect == "unnamed" ? "unnamed, " + f.variable : f.effect};
    group.insert(group.end(), f.alternatives.begin(), f.alternatives.end());
    names.push_back(joined(group, " | "));
  }
  return names.empty() ? name_of(w.verdict) : joined(names, " + ");
}

// Without insufficient ones, which are neither right nor wrong.
std::vector<Proof> answered_of(std::span<const Proof> proofs) {
  std::vector<Proof> out(proofs.begin(), proofs.end());
  for (Proof& p : out) {
    std::erase_if(p.worlds, [](const ProofWorld& w) { return w.insufficient(); });
  }
  return out;
}

// "95.1 to 99.0 %", of a fraction.
// How many intervals hold the truth: the baseline's by path, all others together.
struct Coverage {
  int worlds = 0, all = 0, held = 0;
  std::map<std::string, std::pair<int, int>> by;

  void add(const ProofWorld& w) {
    worlds += 1;
    for (const ProofInterval& i : w.intervals) {
      auto& [in, of] = by[i.of_effect(w.effects) ? "the effects' own" : i.path];
      of += 1, all += 1;
      if (i.holds()) in += 1, held += 1;
    }
  }
  /// "95 % intervals that hold the truth: ..." and a line a parameter.
  ReportSection section(const std::string& title) const {
    ReportSection out{title + " (" + std::to_string(worlds) + ")"};
    const auto add = [&](const std::string& of, int n, int in_all) {
      out.above.push_back(of + ": " + count_text(n, in_all) + " (" + range_text(n, in_all) + ")");
    };
    add("95 % intervals that hold the truth", held, all);
    for (const auto& [path, n] : by) add(path, n.first, n.second);
    return out;
  }
};

// Of null experiments with the verdict `complete`.
void add_baselines(const Proof& proof, ReportDocument& report) {
  Coverage coverage;
  for (const ProofWorld& w : proof.worlds) {
    if (w.kind == "null" && !w.intervals.empty()) coverage.add(w);
  }
  if (coverage.worlds == 0) return;
  report.sections.push_back(coverage.section("Baseline parameters of null experiments"));
}

// Intervals, fraction removed and gain of the experiments whose model was fitted.
void add_models(const Proof& proof, ReportDocument& report) {
  Coverage coverage;
  int gained = 0;
  std::vector<double> removed;
  for (const ProofWorld& w : proof.worlds) {
    if (w.kind == "null" || w.intervals.empty()) continue;
    coverage.add(w), gained += w.gain_low > 0 ? 1 : 0;
    if (!std::isnan(w.removed)) removed.push_back(w.removed);
  }
  if (coverage.worlds == 0) return;
  std::sort(removed.begin(), removed.end());
  ReportSection section = coverage.section("Fitted models of correctly diagnosed experiments");
  if (!removed.empty()) {
    const auto most = static_cast<int>(
        std::count_if(removed.begin(), removed.end(), [](double r) { return r >= 0.7; }));
    section.above.push_back("Fraction of a clear mismatch removed on further recordings: median " +
                            fixed(100 * removed[removed.size() / 2], 0) + " %, least " +
                            fixed(100 * removed.front(), 0) + " %, 70 % and more in " +
                            count_text(most, static_cast<int>(removed.size())));
  }
  section.above.push_back("Log-likelihood gain one step ahead above 0 in " +
                          count_text(gained, coverage.worlds));
  report.sections.push_back(std::move(section));
}

// Groups that proposals were to split, and repeating the recordings beside that.
void add_loops(const Proof& proof, ReportDocument& report) {
  ReportSection section{"Closed loop: groups of effects, split by proposed experiments"};
  section.table.head = {"ground truth", "group",     "proposals", "min",
                        "left",         "repeating", "min",       "left"};
  int groups = 0, split = 0, right = 0;
  double minutes = 0, repeated = 0;
  const auto outcome = [](bool is_split) { return is_split ? "split" : "not split"; };
  for (const ProofWorld& w : proof.worlds) {
    if (!w.loop) continue;
    const ProofLoop& l = *w.loop;
    groups += 1, split += l.split ? 1 : 0, minutes += l.minutes, repeated += l.repeat_minutes;
    right += l.split && std::ranges::find(w.effects, l.left) != w.effects.end() ? 1 : 0;
    section.table.rows.push_back({key_of(w), joined(l.group, " | "),
                                  joined(l.texts, "; ") + ": " + outcome(l.split),
                                  significant(l.minutes, 3), l.left, outcome(l.repeat_split),
                                  significant(l.repeat_minutes, 3), l.repeat_left});
  }
  if (groups == 0) return;
  section.above = {"Split within two proposals: " + count_text(split, groups) + " (" +
                       range_text(split, groups) + "), with the right effect left in " +
                       count_text(right, split),
                   "Minutes of the proposals: " + significant(minutes, 3) +
                       "; of repeating the recordings, at least: " + significant(repeated, 3)};
  report.sections.push_back(std::move(section));
}

// Proofs of the same tank have the same nulls.
std::string tank_of(const Proof& proof) {
  return proof.tank.empty() ? proof.hash : proof.tank;
}

// How far the MSD of nulls is off at most, by tank.
std::map<std::string, double> largest_displacements(std::span<const Proof> proofs) {
  std::map<std::string, double> out;
  for (const Proof& proof : proofs) {
    for (const ProofWorld& w : proof.worlds) {
      if (w.kind != "null") continue;
      double& largest = out[tank_of(proof)];
      largest = std::max(largest, w.displacement);
    }
  }
  return out;
}

// The same experiments by simpler methods. The MSD's threshold is the largest of its tank's nulls
// themselves, in its favour; without nulls of its tank an experiment does not count.
void add_simpler(std::span<const Proof> proofs, ReportDocument& report) {
  int nulls = 0, alarms = 0, strong = 0, right = 0, wrong = 0, compared = 0, seen = 0, ours = 0;
  const auto largest = largest_displacements(proofs);
  for (const Proof& proof : proofs) {
    const auto of_tank = largest.find(tank_of(proof));
    for (const ProofWorld& w : proof.worlds) {
      if (w.kind == "null") nulls += 1, alarms += w.regression.empty() ? 0 : 1;
      if (w.kind != "named" || w.expected_z < 10) continue;
      strong += 1, ours += w.right() ? 1 : 0;
      right += w.regression == w.effects[0] ? 1 : 0;
      wrong += !w.regression.empty() && w.regression != w.effects[0] ? 1 : 0;
      if (of_tank == largest.end()) continue;
      compared += 1, seen += w.displacement > of_tank->second ? 1 : 0;
    }
  }
  if (nulls == 0 || strong == 0) return;
  ReportSection section{"Simpler methods on the same experiments (one effect, expected z >= 10)"};
  section.table.head = {"method", "right", "wrong name", "false positives"};
  section.table.rows = {{"this diagnosis", count_text(ours, strong), "", ""},
                        {"finite differences with sparse regression", count_text(right, strong),
                         count_text(wrong, strong), count_text(alarms, nulls)},
                        {"MSD alone (notices, does not name)", count_text(seen, compared), "", ""}};
  report.sections.push_back(std::move(section));
}

/// The tables of all experiments together.
void add_worlds(const Proof& proof, ReportDocument& report) {
  struct Rate {
    int right = 0, wrong_name = 0, silent = 0, all = 0;
  };
  std::map<std::string, Rate> rates;
  std::map<std::pair<std::string, std::string>, int> taken;
  for (const ProofWorld& w : proof.worlds) {
    std::vector<std::string> groups{w.kind};
    if (w.kind != "null") {
      groups.push_back(w.kind + (w.expected_z >= 10  ? ", z >= 10"
                                 : w.expected_z >= 5 ? ", 5 <= z < 10"
                                                     : ", z < 5"));
    }
    for (const std::string& g : groups) {
      Rate& r = rates[g];
      r.all += 1, r.right += w.right() ? 1 : 0;
      r.silent += w.verdict == Verdict::complete && w.kind != "null" ? 1 : 0;
      r.wrong_name += w.wrong_name() ? 1 : 0;
    }
    taken[{key_of(w), said_of(w)}] += 1;
  }
  ReportSection table{"Diagnoses by kind of experiment"};
  table.table.head = {"experiments", "n",          "right",         "95 % from",
                      "to",          "wrong name", "no discrepancy"};
  for (const auto& [name, r] : rates) {
    const Estimate e = wilson(r.right, r.all);
    table.table.rows.push_back({name, std::to_string(r.all), std::to_string(r.right),
                                fixed(100 * e.low, 1) + " %", fixed(100 * e.high, 1) + " %",
                                std::to_string(r.wrong_name), std::to_string(r.silent)});
  }
  report.sections.push_back(std::move(table));
  ReportSection confusion{"Ground truth and diagnosis"};
  confusion.detail = true;
  confusion.table.head = {"ground truth", "diagnosis", "times"};
  for (const auto& [pair, n] : taken) {
    confusion.table.rows.push_back({pair.first, pair.second, std::to_string(n)});
  }
  report.sections.push_back(std::move(confusion));
}

// Insufficient experiments, and the requirements that they do not meet.
void add_insufficient(std::span<const Proof> proofs, ReportDocument& report) {
  int all = 0;
  std::map<Requirement, int> by;
  for (const Proof& p : proofs) {
    for (const ProofWorld& w : p.worlds) {
      all += w.insufficient() ? 1 : 0;
      for (const Requirement r : w.shortfalls) by[r] += 1;
    }
  }
  if (all == 0) return;
  report.card.facts.emplace_back("insufficient recordings", std::to_string(all));
  ReportSection section{"Insufficient recordings (" + std::to_string(all) + ")"};
  section.table.head = {"requirement that is not met", "experiments"};
  for (const auto& [r, n] : by) section.table.rows.push_back({name_of(r), std::to_string(n)});
  report.sections.push_back(std::move(section));
}

ReportCard card_of(const Proof& proof, std::size_t tanks) {
  ReportCard card;
  int nulls = 0, alarms = 0, strong = 0, right = 0, wrong = 0;
  for (const ProofWorld& w : proof.worlds) {
    if (w.kind == "null") nulls += 1, alarms += w.right() ? 0 : 1;
    if (w.kind == "named" && w.expected_z >= 10) strong += 1, right += w.right() ? 1 : 0;
    wrong += w.wrong_name() ? 1 : 0;
  }
  card.verdict = std::to_string(proof.worlds.size()) + " of " + std::to_string(proof.sealed) +
                 " experiments diagnosed" +
                 (tanks > 1 ? ", in " + std::to_string(tanks) + " tanks or sets of balls" : "") +
                 (tanks == 1 && !proof.tank.empty() ? ", in " + proof.tank : "");
  if (nulls > 0) card.facts.emplace_back("false positives", rate_text(alarms, nulls));
  if (strong > 0) {
    card.facts.emplace_back("one effect of expected z >= 10 named", rate_text(right, strong));
  }
  const auto all = static_cast<int>(proof.worlds.size());
  if (all > 0) card.facts.emplace_back("wrong names", rate_text(wrong, all));
  return card;
}

constexpr std::array<double, 5> kEdges = {0, 5, 10, 20, 1e300};  // of expected z

ProofPoint point_of(const ProofWorld& w) {
  ProofPoint out;
  out.row = w.kind == "two"       ? "two effects"
            : w.kind == "unnamed" ? "a law of no effect"
                                  : w.effects[0];
  out.expected_z = std::max(w.expected_z, ProofFigures::kLeastZ);
  // A wrong name is one, whatever is right beside it.
  if (w.wrong_name()) {
    out.outcome = ProofPoint::Outcome::wrong_name;
  } else if (w.right()) {
    out.outcome = ProofPoint::Outcome::right;
  } else if (w.verdict == Verdict::complete) {
    out.outcome = ProofPoint::Outcome::silent;
  }
  return out;
}

std::vector<ProofPower> power_of(std::span<const Proof> proofs, const std::string& kind) {
  std::array<ProofPower, kEdges.size() - 1> ranges;
  for (const Proof& p : proofs) {
    for (const ProofWorld& w : p.worlds) {
      if (w.kind != kind) continue;
      const auto above = std::upper_bound(kEdges.begin() + 1, kEdges.end() - 1, w.expected_z);
      ProofPower& of = ranges[static_cast<std::size_t>(above - kEdges.begin() - 1)];
      of.all += 1, of.right += w.right() ? 1 : 0;
      of.z += std::log(std::max(w.expected_z, ProofFigures::kLeastZ));
    }
  }
  std::vector<ProofPower> out;
  for (ProofPower of : ranges) {
    if (of.all == 0) continue;
    const Estimate share = wilson(of.right, of.all);
    of.z = std::exp(of.z / of.all), of.low = share.low, of.high = share.high;
    out.push_back(of);
  }
  return out;
}

double in_half_widths(const ProofInterval& of) {
  const double off = of.value - of.truth, half = off > 0 ? of.value - of.low : of.high - of.value;
  if (off == 0) return 0;
  return half > 0 ? off / half : std::copysign(std::numeric_limits<double>::infinity(), off);
}

}  // namespace

ReportDocument proof_report(std::span<const Proof> judged) {
  const std::vector<Proof> proofs = answered_of(judged);
  Proof all;
  ReportSection keys{"Commitment", {}, {}, {}, true};
  std::set<std::string> tanks;
  for (const Proof& p : proofs) {
    tanks.insert(tank_of(p));
    all.worlds.insert(all.worlds.end(), p.worlds.begin(), p.worlds.end());
    all.sealed += p.sealed, all.tank = proofs.size() == 1 ? p.tank : "";
    keys.above.push_back("SHA-256 of the ground truth (key.txt)" +
                         (proofs.size() > 1 && !p.dir.empty() ? " of " + p.dir : "") + ": " +
                         p.hash);
  }
  ReportDocument report;
  report.title = "Blinded synthetic benchmark";
  report.card = card_of(all, tanks.size());
  report.sections.push_back(std::move(keys));
  add_insufficient(judged, report);
  if (!all.worlds.empty()) add_worlds(all, report);
  add_baselines(all, report);
  add_models(all, report);
  add_loops(all, report);
  add_simpler(proofs, report);
  return report;
}

std::string proof_text(std::span<const Proof> proofs) {
  return report_text(proof_report(proofs));
}

ProofFigures proof_figures(std::span<const Proof> judged) {
  const std::vector<Proof> proofs = answered_of(judged);
  ProofFigures out;
  for (const Proof& p : proofs) {
    for (const ProofWorld& w : p.worlds) {
      if (w.kind != "null") out.points.push_back(point_of(w));
      for (const ProofInterval& of : w.intervals) {
        (of.of_effect(w.effects) ? out.effect_errors : out.baseline_errors)
            .push_back(in_half_widths(of));
      }
    }
  }
  std::sort(out.baseline_errors.begin(), out.baseline_errors.end());
  std::sort(out.effect_errors.begin(), out.effect_errors.end());
  out.named = power_of(proofs, "named"), out.two = power_of(proofs, "two");
  out.unnamed = power_of(proofs, "unnamed");
  return out;
}

}  // namespace lilytank
