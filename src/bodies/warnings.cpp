// What a report of point bodies warns of, once something was found.
#include <algorithm>
#include <cmath>

#include "bodies/verdict.hpp"
#include "text/number.hpp"

namespace lilytank::bodies {
namespace {

// Bodies that are let go in known fields should not be pushed about: what is left then is the
// measurement's, or a law's that is not in the library.
void warn_of_pushes(const Comparison& c, Diagnosis& d) {
  double left = 0, had = 0;
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    left += std::pow(c.reported->fits[i].model.push, 2),
        had += std::pow(c.baseline.fits[i].model.push, 2);
  }
  const auto n = static_cast<double>(c.groups.size());
  double far = 0, floor = 0;
  for (std::size_t i = 0; i < c.far_after.size(); ++i) {
    far += c.far_after[i], floor += std::pow(c.reported->fits[i].model.noise, 2);
  }
  if (far < 5 * floor) return;
  d.warnings.push_back(
      "irregular accelerations of " + significant(std::sqrt(left / n), 2) + " " +
      c.experiment->unit + "/s^2 rms are left (" + significant(std::sqrt(had / n), 2) +
      " without the findings): where nothing pushes these bodies at random, suspect the "
      "measurement (release, clock, scale); laws that differ by less along this motion are not "
      "distinguished");
}

void warn_of_coefficients(const Comparison& c, Diagnosis& d) {
  const LawTrial& best = *c.reported;
  if (c.repeats.z() > 3) {
    d.warnings.push_back("runs of the same bodies disagree in the coefficients of " +
                         std::string(best.candidate.laws.back()->name) + " by " +
                         significant(c.repeats.factor(), 2) + " times their errors" +
                         (c.repeats.worst.empty() ? "" : " (most: " + c.repeats.worst + ")") +
                         ": suspect the measurement (release, clock, scale); intervals are widened "
                         "by that, and fits that differ by less do not distinguish the "
                         "laws");
  }
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    const BodyModel& m = best.fits[i].model;
    for (const Term& t : m.terms) {
      const bool drag = t.law->variable == "slip" && !t.law->curve;
      if (drag && t.value[0] < 0 && t.fitted[0] && c.groups.size() == 1) {
        d.warnings.push_back(std::string(t.law->name) +
                             " comes out negative, which no drag is: how the loss is shared out "
                             "between these laws is not identified");
      }
    }
  }
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
    if (!without.noise_fitted || with.noise > without.noise / 2) continue;
    const std::string& unit = c.experiment->unit;
    of += (of.empty() ? "" : "; ") + (c.groups[i].name.empty() ? "" : c.groups[i].name + ": ") +
          significant(with.noise, 3) + " " + unit + " with the findings, " +
          significant(without.noise, 3) + " " + unit + " without";
  }
  if (of.empty()) return;
  d.warnings.push_back("the simple model takes motion for noise of the tracker (" + of +
                       "): predictions far ahead are compared at the smaller noise; noise in "
                       "[experiment] fixes it");
}

}  // namespace

void add_warnings(const Comparison& c, Diagnosis& d) {
  warn_of_pushes(c, d);
  warn_of_coefficients(c, d);
  warn_of_worse(d);
  warn_of_noise(c, d);
}

}  // namespace lilytank::bodies
