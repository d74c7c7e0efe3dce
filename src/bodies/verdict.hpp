// From comparisons to words.
#pragma once
#include <optional>
#include <span>

#include "bodies/compare.hpp"

namespace lilytank::bodies {

/// Everything that was compared.
struct Comparison {
  const BodyExperiment* experiment = nullptr;
  std::vector<Group> groups;
  LawTrial baseline;
  std::vector<LawTrial> singles;       ///< best first
  std::vector<LawTrial> pairs;         ///< best first
  std::vector<LawTrial> triples;       ///< best first: a reported pair with each other law
  std::vector<std::string> failures;   ///< laws that were not evaluated, and why
  std::vector<double> nulls;           ///< best gains by chance, sorted
  const LawTrial* reported = nullptr;  ///< of all parts of the report; select() sets it
  Repeats repeats;                     ///< of the reported laws
  std::optional<LawTrial> rotation;    ///< the reported laws, but with a rotation of any rate
  std::vector<double> far_before, far_after;  ///< mean squares of far predictions, m^2
  double false_alarms = 0.02;

  /// Gain that a share of `false_alarms` of complete experiments exceed.
  double threshold() const;
  /// Probability of such a gain by chance: a share of the nulls, and beyond them by likelihood.
  double chance(double gain) const;
  /// The laws that are to be reported, by the repeats so far.
  const LawTrial& choice() const;
  /// Chooses the reported laws and compares the runs with them.
  void select();
  bool distinguished(const LawTrial& better, const LawTrial& worse) const;
  /// Trials of so many laws: one, two or three.
  const std::vector<LawTrial>& trials_of(std::size_t laws) const;
  /// The outcome of these laws in any order, the baseline's of none; null where it was not
  /// evaluated.
  const LawTrial* outcome_of(std::span<const Law* const> laws) const;
  /// Other named laws, as many as are reported, that are not distinguished from these.
  std::vector<const LawTrial*> alternatives() const;
  /// Unnamed laws that predict better than the reported ones and are not distinguished from them.
  std::vector<const LawTrial*> better_unnamed() const;

 private:
  /// Whether the gains alone distinguish them.
  bool by_gain(const LawTrial& better, const LawTrial& worse) const;
  std::vector<const LawTrial*> special_cases(const LawTrial& of) const;
  const LawTrial& simplest(const LawTrial& of) const;
};

/// Adds warnings about the model that a verdict is of: the reported laws, or the baseline where
/// nothing was found. The diagnosis has its findings and its fit.
void add_warnings(const Comparison& comparison, const LawTrial& model, Diagnosis& diagnosis);

/// A diagnosis with the name, the bodies and the runs of an experiment, and nothing found.
Diagnosis described(const BodyExperiment& experiment);
Diagnosis diagnosis_of(const Comparison& comparison);

}  // namespace lilytank::bodies
