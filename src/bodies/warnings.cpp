// What a report of point bodies warns of.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bodies/verdict.hpp"
#include "text/number.hpp"

namespace lilytank::bodies {
namespace {

double total(const std::vector<double>& of) {
  return std::accumulate(of.begin(), of.end(), 0.0);
}

// Random accelerations explain errors of predictions up to some size, which simulations of the
// model show. Beyond it something else acts: a law that is not in the library, or a fault.
void warn_of_far_errors(const Comparison& c, const LawTrial& model, Diagnosis& d) {
  constexpr double kMore = 1.5;
  const double expected = total(largest_far_errors(c.groups, model));
  const std::vector<double> far = far_errors(c.groups, model);
  if (total(far) < kMore * expected) return;
  double pushes = 0;
  for (const Fitted& f : model.fits) pushes += std::pow(f.model.push, 2);
  const auto n = static_cast<double>(far.size());
  const std::string& unit = c.experiment->unit;
  d.warnings.push_back(
      "predictions a quarter of a run ahead miss by " + significant(std::sqrt(total(far) / n), 2) +
      " " + unit + " rms; the irregular accelerations of " + significant(std::sqrt(pushes / n), 2) +
      " " + unit + "/s^2 rms that are left explain " + significant(std::sqrt(expected / n), 2) +
      " " + unit +
      " at most: a law that is not in the library, or else suspect the measurement "
      "(release, clock, scale)");
}

// Process noise that is not far below what the laws explain is no proof of them: bodies that are
// let go in known fields should not be pushed about.
void warn_of_pushes(const Comparison& c, Diagnosis& d) {
  constexpr double kFar = 3;
  if (acceleration_difference(c.groups, *c.reported, c.baseline) > kFar) return;
  double left = 0, had = 0;
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    left += std::pow(c.reported->fits[i].model.push, 2),
        had += std::pow(c.baseline.fits[i].model.push, 2);
  }
  const auto n = static_cast<double>(c.groups.size());
  d.warnings.push_back(
      "irregular accelerations of " + significant(std::sqrt(left / n), 2) + " " +
      c.experiment->unit + "/s^2 rms are left (" + significant(std::sqrt(had / n), 2) +
      " without the findings), more than a third of what the findings explain: where nothing "
      "pushes these bodies at random, suspect the measurement (release, clock, scale)");
}

// Drags that add energy, by more than two standard errors.
void warn_of_signs(const Comparison& c, const LawTrial& model, Diagnosis& d) {
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    const BodyModel& m = model.fits[i].model;
    for (std::size_t k = 0; k < m.terms.size(); ++k) {
      const Term& t = m.terms[k];
      const auto at = number_of(m, {k, 0});
      const bool drag = t.law->variable == "slip" || t.law->variable == "medium slip";
      if (!drag || t.law->curve || !at) continue;
      if (model.fits[i].numbers[*at] > -2 * c.repeats.factor() * model.fits[i].deviation[*at]) {
        continue;
      }
      const std::string of = c.groups[i].name.empty() ? "" : " of " + c.groups[i].name;
      d.warnings.push_back(std::string(t.law->name) + of + " comes out negative (" +
                           significant(t.value[0], 2) +
                           "), which no drag is: something drives the body, or how the loss is "
                           "divided among these laws is not identified");
    }
  }
}

void warn_of_repeats(const Comparison& c, Diagnosis& d) {
  if (c.repeats.z() < 3) return;
  d.warnings.push_back("runs of the same bodies disagree in the coefficients of " +
                       std::string(c.reported->candidate.laws.back()->name) + " by " +
                       significant(c.repeats.factor(), 2) + " times their errors" +
                       (c.repeats.worst.empty() ? "" : " (most: " + c.repeats.worst + ")") +
                       ": suspect the measurement (release, clock, scale), or fit coefficients = "
                       "\"each run\"; intervals are widened by that, and fits that differ by less "
                       "do not distinguish the laws");
}

// Predictions far ahead that the findings make worse, beyond the noise.
void warn_of_worse(Diagnosis& d) {
  std::string worse;
  for (const GroupFit& g : d.held_out) {
    if (g.after <= std::max(1.0, g.before)) continue;
    worse += (worse.empty() ? "" : ", ") + g.group + " (" + significant(g.before, 3) + " to " +
             significant(g.after, 3) + " times the noise's mean square)";
  }
  if (worse.empty()) return;
  d.warnings.push_back(
      "with the findings, predictions a quarter of a run ahead are worse than without: " + worse +
      "; noise in [experiment], or samples closer together, may mend that");
}

// Where the simple model takes motion for the tracker's noise.
void warn_of_noise(const Comparison& c, Diagnosis& d) {
  std::string of;
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    const BodyModel &without = c.baseline.fits[i].model, &with = c.reported->fits[i].model;
    if (!absorbs_motion(without, with)) continue;
    const std::string& unit = c.experiment->unit;
    of += (of.empty() ? "" : "; ") + (c.groups[i].name.empty() ? "" : c.groups[i].name + ": ") +
          significant(std::sqrt(with.squared_noise()), 3) + " " + unit + " with the findings, " +
          significant(std::sqrt(without.squared_noise()), 3) + " " + unit + " without";
  }
  if (of.empty()) return;
  d.warnings.push_back("the simple model takes motion for noise of the tracker (" + of +
                       "): predictions far ahead are compared at the smaller noise; noise in "
                       "[experiment] fixes it");
}

}  // namespace

void add_warnings(const Comparison& c, const LawTrial& model, Diagnosis& d) {
  warn_of_far_errors(c, model, d);
  if (&model == c.reported) warn_of_pushes(c, d);
  warn_of_signs(c, model, d);
  if (&model != c.reported) return;
  warn_of_repeats(c, d);
  warn_of_worse(d);
  warn_of_noise(c, d);
}

}  // namespace lilytank::bodies
