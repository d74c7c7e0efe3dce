// From comparisons to words.
#pragma once
#include "bodies/compare.hpp"

namespace lilytank::bodies {

/// Everything that was compared.
struct Comparison {
  const BodyExperiment* experiment = nullptr;
  std::vector<Group> groups;
  LawTrial baseline;
  std::vector<LawTrial> singles;              ///< best first
  std::vector<LawTrial> pairs;                ///< best first
  std::vector<std::string> failures;          ///< laws that were not evaluated, and why
  std::vector<double> nulls;                  ///< best gains by chance, sorted
  Repeats repeats;                            ///< of the best outcome
  std::vector<double> far_before, far_after;  ///< mean squares of far predictions, m^2
  double false_alarms = 0.02;

  /// Gain that a share of `false_alarms` of complete experiments exceed.
  double threshold() const;
  /// Probability of such a gain by chance: a share of the nulls, and beyond them by likelihood.
  double chance(double gain) const;
  /// The pair that is reported; null where one law, or none, does.
  const LawTrial* pair() const;
  const LawTrial& best() const;
  bool apart(const LawTrial& better, const LawTrial& worse) const;
};

/// Adds warnings about the best outcome to a diagnosis that has its findings and its fit.
void add_warnings(const Comparison& comparison, Diagnosis& diagnosis);

Diagnosis diagnosis_of(const Comparison& comparison);

}  // namespace lilytank::bodies
