#include "bodies/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "bodies/distribution.hpp"
#include "bodies/maps.hpp"
#include "statistics/largest_first.hpp"
#include "statistics/quantiles.hpp"
#include "text/words.hpp"

namespace lilytank::bodies {
namespace {

constexpr std::size_t kSumsReported = 5;  // of as many laws

// Units of a law's parameter for the experiment's: forces are per mass where masses are unknown.
std::string unit_for(const BodyExperiment& e, std::string unit) {
  static const std::map<std::string, std::string> kPerMass{{"N", "m/s^2"},
                                                           {"N/m", "1/s^2"},
                                                           {"N/m^3", "1/(m^2 s^2)"},
                                                           {"N s/m", "1/s"},
                                                           {"N s^2/m^2", "1/m"}};
  if (const auto own = kPerMass.find(unit); !e.masses && own != kPerMass.end()) unit = own->second;
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (auto at = unit.find(from); at != std::string::npos; at = unit.find(from, at + to.size())) {
      unit.replace(at, from.size(), to);
    }
  };
  replace("m", e.unit);
  return unit;
}

std::string of_group(const Group& g) {
  return g.name.empty() ? "" : " of " + g.name;
}

// The driver of a law of one alone; -1: it is of several, or of none.
int driver_of(const Term& t) {
  if (t.law->variable != "driver" || t.parameters.back().kind != Kind::driver) return -1;
  return static_cast<int>(t.value.back());
}

// Of a force by drivers: the driver's own name and the axis.
std::string name_of(const BodyExperiment& e, const Term& t, std::size_t number) {
  if (t.law->variable != "driver") return t.parameters[number].name;
  const auto axes = static_cast<std::size_t>(e.dimensions);
  const int one = driver_of(t);
  return e.drivers[one < 0 ? number / axes : static_cast<std::size_t>(one)] + (axes == 1 ? ""
                                                                               : number % axes == 0
                                                                                   ? ", along x"
                                                                                   : ", along y");
}

// A parameter of a fit; where it is fitted, with its 95 % interval.
FoundParameter parameter_of(const Comparison& c, std::size_t group, const Fitted& fit,
                            const TermParameter& of) {
  const Term& t = fit.model.terms[of.term];
  const LawParameter& p = t.parameters[of.parameter];
  FoundParameter out{name_of(*c.experiment, t, of.parameter) + of_group(c.groups[group]),
                     std::string(t.law->name) + "." + p.name};
  out.value = out.low = out.high = t.value[of.parameter];
  out.unit = unit_for(*c.experiment, p.unit);
  const auto at = number_of(fit.model, of);
  if (!at) return out;
  const double half = normal_half_width();
  const auto end = [&](double by) {
    const double number = fit.numbers[*at] + by * (fit.deviation[*at] * c.repeats.factor());
    return p.kind == Kind::positive ? std::exp(number) : number * t.scale[of.parameter];
  };
  out.low = end(-half), out.high = end(half);
  return out;
}

// Frontal area of a group's bodies, m^2; 0: not known, or not the same of all.
double frontal_area(const Group& group) {
  const double radius = group.runs.front()->radius.front();
  for (const BodyRun* run : group.runs) {
    for (const double r : run->radius) {
      if (r != radius) return 0;
    }
  }
  return std::numbers::pi * radius * radius;
}

// Cd of a quadratic drag F = 1/2 rho Cd A v^2, where density, masses and radii are known.
std::optional<FoundParameter> drag_coefficient(const Comparison& c, std::size_t group,
                                               const LawParameter& of, const FoundParameter& p) {
  const double pressure = 0.5 * c.experiment->density * frontal_area(c.groups[group]);
  if (of.unit != "N s^2/m^2" || !c.experiment->masses || !(pressure > 0)) return std::nullopt;
  FoundParameter out = p;
  out.name = "Cd" + of_group(c.groups[group]), out.path = p.path + ".Cd", out.unit = "1";
  for (double* number : {&out.value, &out.low, &out.high}) *number /= pressure;
  return out;
}

std::string groups_in(const Comparison& c) {
  return c.experiment->coefficients == Coefficients::each_run ? "runs" : "bodies";
}

void add_summary(const Comparison& c, const std::vector<FoundParameter>& all, DiagnosisFinding& f) {
  const std::vector<FoundParameter> more = summarized(all, c.groups.size(), groups_in(c));
  f.parameters.insert(f.parameters.end(), more.begin(), more.end());
}

void add_parameters(const Comparison& c, const LawTrial& o, std::size_t law, DiagnosisFinding& f) {
  std::vector<FoundParameter> all;
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    const Fitted& fit = o.fits[i];
    const std::size_t k = fit.model.terms.size() - o.candidate.laws.size() + law;
    const Term& t = fit.model.terms[k];
    for (std::size_t p = 0; p < t.value.size(); ++p) {
      if (t.parameters[p].kind == Kind::driver) continue;
      if (t.fitted[p] || c.groups.size() == 1) {
        all.push_back(parameter_of(c, i, fit, {k, p}));
        const auto cd = drag_coefficient(c, i, t.parameters[p], all.back());
        if (cd) all.push_back(*cd);
      }
    }
  }
  add_summary(c, all, f);
}

// f over all samples; 0 where it is not known.
double mean_turning(const Comparison& c) {
  const BodyExperiment& e = *c.experiment;
  if (e.latitude < 0) return e.turning;
  double sum = 0, n = 0;
  for (const BodyRun& run : e.runs) {
    for (std::size_t k = 0; k < run.samples(); ++k, ++n) {
      sum += inertial_turning(run.drivers_at(k)[e.latitude]);
    }
  }
  return sum / n;
}

// The rate of a free rotation beside the rates that have names.
void add_rotation(const Comparison& c, DiagnosisFinding& f) {
  if (!c.rotation) return;
  std::vector<FoundParameter> rates;
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    const Fitted& fit = c.rotation->fits[i];
    rates.push_back(parameter_of(c, i, fit, {fit.model.terms.size() - 1, 0}));
    rates.back().name = "rate of a free rotation, clockwise" + of_group(c.groups[i]);
  }
  add_summary(c, rates, f);
  const auto known = [&](const std::string& name, double rate) {
    f.parameters.push_back({name, name, rate, rate, rate, "rad/s"});
  };
  if (const double f0 = mean_turning(c); f0 != 0) known("f of the latitude, clockwise", f0);
  known("M2 tide, of either sense", kTideRate);
}

// Interval of a gain by resampling blocks (2.5 % and 97.5 % of their normal approximation).
void add_gain(const Comparison& c, const LawTrial& o, const LawTrial& without,
              DiagnosisFinding& f) {
  const Difference d = difference(o.by_block, without.by_block);
  const double half = normal_half_width() * d.error;
  f.gain = d.value, f.gain_low = d.value - half, f.gain_high = d.value + half;
  f.z = std::sqrt(2 * std::max(0.0, d.value));
  f.confidence = 1 - std::min(1.0, c.chance(d.value));
}

std::string strongest_bodies(const Comparison& c, const LawTrial& o) {
  if (c.groups.size() < 2) return "";
  std::vector<std::pair<double, std::string>> by;
  std::vector<std::string> seen, none, untested;
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    const std::string& name = c.groups[i].name;
    if (o.fits[i].held_out.empty())
      untested.push_back(name);
    else
      by.emplace_back(o.fits[i].held_out_sum() - c.baseline.fits[i].held_out_sum(), name);
  }
  std::sort(by.rbegin(), by.rend());
  for (const auto& [gain, name] : by) (gain > 2 ? seen : none).push_back(name);
  if (by.size() > kMostListed) {
    return "seen in " + std::to_string(seen.size()) + " of " + std::to_string(by.size()) + " " +
           groups_in(c) + " alone";
  }
  std::string out = "seen in " + (seen.empty() ? "no body alone" : joined(seen, ", "));
  if (!none.empty()) out += "; not in " + joined(none, ", ");
  if (!untested.empty())
    out += "; not tested, because none of their runs is held out: " + joined(untested, ", ");
  return out;
}

// Laws without a variable act everywhere.
std::string variable_or_position(const Law& law) {
  return std::string(law.variable.empty() ? "position" : law.variable);
}

void set_range(const Comparison& c, const std::string& variable, DiagnosisFinding& f) {
  f.variable = variable;
  f.from = 1e300, f.to = -1e300;
  for (const Group& g : c.groups) {
    const VariableRange range = range_of(variable, g.typical);
    f.from = std::min(f.from, range.low), f.to = std::max(f.to, range.high);
  }
  f.unit = unit_of(variable, c.experiment->unit);
}

std::vector<DiagnosisFinding> findings(const Comparison& c) {
  std::vector<DiagnosisFinding> out;
  const LawTrial& head = *c.reported;
  const std::vector<const LawTrial*> others = c.alternatives();
  const std::size_t laws = head.candidate.laws.size();
  for (std::size_t k = 0; k < laws; ++k) {
    const Law& law = *head.candidate.laws[k];
    DiagnosisFinding f;
    f.effect = law.name, f.equation = law.equation, f.split = law.split;
    set_range(c, variable_or_position(law), f);
    f.text = strongest_bodies(c, head);
    const BodyModel& fitted = head.fits.front().model;
    if (const int one = driver_of(fitted.terms[fitted.terms.size() - laws + k]); one >= 0) {
      f.text = "by " + c.experiment->drivers[static_cast<std::size_t>(one)] +
               (f.text.empty() ? "" : "; " + f.text);
    }
    std::vector<const Law*> rest = head.candidate.laws;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
    const LawTrial* without = c.outcome_of(rest);
    add_gain(c, head, without != nullptr ? *without : c.baseline, f);
    add_parameters(c, head, k, f);
    if (law.variable == "turn") add_rotation(c, f);
    std::set<std::string> names;
    for (const LawTrial* o : others) {
      // Of several laws, the one that ours do not share stands for this one.
      const auto has = [](const std::vector<const Law*>& all, const Law* one) {
        return std::ranges::find(all, one) != all.end();
      };
      const auto& other = o->candidate.laws;
      if (!std::ranges::all_of(rest, [&](const Law* l) { return has(other, l); })) continue;
      for (const Law* l : other) {
        if (!has(head.candidate.laws, l)) names.insert(std::string(l->name));
      }
    }
    f.alternatives.assign(names.begin(), names.end());
    for (const LawTrial* o : c.better_unnamed()) {
      f.alternatives.push_back("an unnamed law over " +
                               variable_or_position(*o->candidate.laws.front()));
    }
    if (law.curve) {
      f.effect = "unnamed";
      f.text = "no law of the library predicts as well as a free law over " + f.variable +
               (f.text.empty() ? "" : "; " + f.text);
    }
    f.curve = map_of(c, f.variable);
    out.push_back(std::move(f));
  }
  largest_first(out, &DiagnosisFinding::gain);
  return out;
}

void add_fit(const Comparison& c, Diagnosis& d) {
  double before = 0, after = 0, floor = 0;
  for (std::size_t i = 0; i < c.far_before.size(); ++i) {
    const double noise = c.reported->fits[i].model.squared_noise();
    const std::string name = c.groups[i].name.empty() ? "all bodies" : c.groups[i].name;
    d.held_out.push_back({name, c.far_before[i] / noise, c.far_after[i] / noise});
    const auto n = static_cast<double>(c.far_before.size());
    before += c.far_before[i] / n, after += c.far_after[i] / n, floor += noise / n;
  }
  d.msd_before = before, d.msd_after = after, d.msd_floor = floor;
  d.msd_removed = before > floor ? std::clamp((before - after) / (before - floor), -1.0, 1.0) : 0;
  d.msd_low = d.msd_high = d.msd_removed;
}

// Tracking and process noise, rms over the groups; with their interval where there is one group.
void add_noise(const Comparison& c, const LawTrial& with, Diagnosis& d) {
  const auto n = static_cast<double>(c.groups.size());
  std::vector<OwnValue> squares[2];
  for (std::size_t side = 0; side < 2; ++side) {
    for (const Fitted& f : (side == 0 ? c.baseline : with).fits) {
      std::vector<OwnValue> own = own_values(f.model);
      if (squares[side].empty()) {
        squares[side] = own;
        for (OwnValue& v : squares[side]) v.value = 0;
      }
      for (std::size_t k = 0; k < own.size(); ++k) {
        squares[side][k].value += own[k].value * own[k].value / n;
      }
    }
  }
  for (std::size_t k = 0; k < squares[0].size(); ++k) {
    const double value = std::sqrt(squares[1][k].value);
    MovedParameter& p = d.parameters.emplace_back();
    p.path = squares[0][k].name, p.unit = unit_for(*c.experiment, squares[0][k].unit);
    p.baseline = std::sqrt(squares[0][k].value), p.with_effects = value;
    if (c.groups.size() > 1) continue;
    p.deviation = p.baseline * c.baseline.fits[0].deviation[k];
    const double half = normal_half_width() * with.fits[0].deviation[k];
    const OwnValue& own = squares[1][k];
    p.low = std::max(value * std::exp(-half), own.least);
    p.high = std::min(value * std::exp(half), own.most);
  }
}

// The median of each path, as there are too many groups for a line each.
std::vector<MovedParameter> medians_of(const std::vector<MovedParameter>& all, std::size_t groups) {
  std::map<std::string, std::vector<MovedParameter>> by_path;
  for (const MovedParameter& p : all) by_path[p.path].push_back(p);
  std::vector<MovedParameter> out;
  for (auto& [path, of] : by_path) {
    const auto middle = [&](double MovedParameter::*value) {
      std::ranges::nth_element(of, of.begin() + std::ssize(of) / 2, {}, value);
      return of[of.size() / 2].*value;
    };
    MovedParameter& p = out.emplace_back();
    p.path = path + ", median of " + std::to_string(groups), p.unit = of[0].unit;
    p.baseline = middle(&MovedParameter::baseline),
    p.with_effects = middle(&MovedParameter::with_effects);
  }
  return out;
}

// Fitted parameters of the baseline, alone and in `with`.
void add_moved(const Comparison& c, const LawTrial& with, Diagnosis& d) {
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    const Fitted &a = c.baseline.fits[i], &b = with.fits[i];
    for (const TermParameter& of : fitted_parameters(a.model)) {
      const Term& t = a.model.terms[of.term];
      const double value = t.value[of.parameter];
      const bool log = t.parameters[of.parameter].kind == Kind::positive;
      const FoundParameter now = parameter_of(c, i, b, of);
      const std::string of_one = c.groups.size() > kMostListed ? "" : of_group(c.groups[i]);
      d.parameters.push_back({now.path + of_one, now.unit, value,
                              c.repeats.factor() * a.deviation[*number_of(a.model, of)] *
                                  (log ? value : t.scale[of.parameter]),
                              now.value, now.low, now.high});
    }
  }
  if (c.groups.size() > kMostListed) d.parameters = medians_of(d.parameters, c.groups.size());
  add_noise(c, with, d);
}

// An amplitude that gains what chance does not: half a square of deviations, less its own cost.
void add_detectable(const Comparison& c, Diagnosis& d) {
  for (const LawTrial& o : c.singles) {
    const Term& t = o.fits.front().model.terms.back();
    if (t.parameters[0].kind != Kind::amplitude || t.law->curve) continue;
    double least = 1e300;
    for (const Fitted& f : o.fits) {
      const std::size_t last = f.model.terms.size() - 1;
      const std::size_t at = *number_of(f.model, {last, 0});
      least = std::min(least, f.model.terms[last].scale[0] * f.deviation[at]);
    }
    const double seen = least * std::sqrt(2 * (c.threshold() + 1));
    d.detectable.push_back({std::string(t.law->name), name_of(*c.experiment, t, 0), seen, seen,
                            unit_for(*c.experiment, t.parameters[0].unit)});
  }
}

// All single laws and the first sums of several, by the square root of twice their gain.
void add_ranking(const Comparison& c, Diagnosis& d) {
  const auto add = [&](const LawTrial& o) {
    d.ranking.push_back({o.candidate.name(), "", std::sqrt(2 * std::max(0.0, o.gain))});
  };
  for (const LawTrial& one : c.singles) add(one);
  for (const std::vector<LawTrial>* sums : {&c.pairs, &c.triples}) {
    for (std::size_t k = 0; k < std::min(sums->size(), kSumsReported); ++k) add((*sums)[k]);
  }
  largest_first(d.ranking, &RankedEffect::z);
}

}  // namespace

Diagnosis described(const BodyExperiment& e) {
  Diagnosis d;
  d.name = e.name, d.subject = &kPointBodies;
  d.recordings = static_cast<int>(e.runs.size());
  d.checks = e.left_out;
  for (const BodyRun& r : e.runs) {
    d.modules = std::max(d.modules, static_cast<int>(r.bodies.size()));
    d.seconds += r.time.back();
  }
  return d;
}

Diagnosis diagnosis_of(const Comparison& c) {
  Diagnosis d = described(*c.experiment);
  d.false_alarms = c.false_alarms, d.effect_threshold = std::sqrt(2 * c.threshold());
  d.shape_threshold = d.effect_threshold;
  const LawTrial& best = *c.reported;
  for (const std::string& failure : c.failures) d.warnings.push_back("not evaluated: " + failure);
  add_ranking(c, d);
  add_detectable(c, d);
  d.maps = maps_of(c);
  const bool found = best.gain > c.threshold();
  add_moved(c, found ? best : c.baseline, d);
  if (!found) {
    d.verdict = Verdict::complete;
    add_warnings(c, c.baseline, d);
    return d;
  }
  const Difference sure = difference(best.by_block, c.baseline.by_block);
  d.verdict =
      sure.value > normal_quantile(0.95) * sure.error ? Verdict::missing : Verdict::undecided;
  d.findings = findings(c);
  add_fit(c, d);
  // What is found must predict the motion itself, not only its next sample.
  if (d.msd_removed < 0 || d.removed() < 0) d.verdict = Verdict::undecided;
  add_warnings(c, best, d);
  return d;
}

}  // namespace lilytank::bodies
