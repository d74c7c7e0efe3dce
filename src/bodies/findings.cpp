// The laws that are reported, with their numbers.
#include "bodies/findings.hpp"

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

// The driver of a law of one alone; -1: it is of several, or of none.
int driver_of(const Term& t) {
  if (t.law->variable != "driver" || t.parameters.back().kind != Kind::driver) return -1;
  return static_cast<int>(t.value.back());
}

}  // namespace

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

std::string name_of(const BodyExperiment& e, const Term& t, std::size_t number) {
  if (t.law->variable != "driver") return t.parameters[number].name;
  const auto axes = static_cast<std::size_t>(e.dimensions);
  const int one = driver_of(t);
  if (one >= 0 && number >= axes) return t.parameters[number].name;
  return e.drivers[one < 0 ? number / axes : static_cast<std::size_t>(one)] + (axes == 1 ? ""
                                                                               : number % axes == 0
                                                                                   ? ", along x"
                                                                                   : ", along y");
}

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

namespace {

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

// How an amplitude grows with the bodies' radii and masses, where each body has its own.
void add_growth(const Comparison& c, const std::vector<FoundParameter>& of, DiagnosisFinding& f) {
  if (c.experiment->coefficients != Coefficients::each_body || of.size() != c.groups.size()) return;
  const auto over = [&](const std::string& size, std::vector<double> BodyRun::*sizes) {
    std::vector<double> each;
    for (const Group& group : c.groups) each.push_back((group.runs.front()->*sizes).front());
    const auto growth = growth_over(each, of);
    if (!growth) return;
    const std::string name = of.front().path.substr(of.front().path.find('.') + 1);
    f.parameters.push_back({name + ", exponent over the " + size, of.front().path + ".over_" + size,
                            growth->exponent, growth->low, growth->high, "1"});
  };
  over("radius", &BodyRun::radius);
  if (c.experiment->masses) over("mass", &BodyRun::mass);
}

void add_parameters(const Comparison& c, const LawTrial& o, std::size_t law, DiagnosisFinding& f) {
  std::vector<FoundParameter> all, amplitudes;
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    const Fitted& fit = o.fits[i];
    const std::size_t k = fit.model.terms.size() - o.candidate.laws.size() + law;
    const Term& t = fit.model.terms[k];
    for (std::size_t p = 0; p < t.value.size(); ++p) {
      if (t.parameters[p].kind == Kind::driver) continue;
      if (t.fitted[p] || c.groups.size() == 1) {
        all.push_back(parameter_of(c, i, fit, {k, p}));
        if (p == 0 && t.parameters[p].kind == Kind::amplitude) amplitudes.push_back(all.back());
        const auto cd = drag_coefficient(c, i, t.parameters[p], all.back());
        if (cd) all.push_back(*cd);
      }
    }
  }
  add_summary(c, all, f);
  add_growth(c, amplitudes, f);
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

}  // namespace

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

}  // namespace lilytank::bodies
