#include "bodies/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "bodies/distribution.hpp"
#include "bodies/findings.hpp"
#include "bodies/maps.hpp"
#include "statistics/largest_first.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank::bodies {
namespace {

constexpr std::size_t kSumsReported = 5;  // of as many laws

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
