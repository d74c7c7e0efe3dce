// Candidate laws beside the baseline: how much better each predicts what it has not seen, and what
// chance alone would give.
#pragma once
#include <functional>

#include "bodies/fit.hpp"
#include "study/kept_rows.hpp"

namespace lilytank::bodies {

/// One or two laws that are added to the baseline.
struct Candidate {
  std::vector<const Law*> laws;
  std::string name() const;  ///< "dry_friction + quadratic_drag"
  bool curve() const;
};

/// A baseline, or a baseline with a candidate, fitted to all groups.
struct LawTrial {
  Candidate candidate;
  std::vector<Fitted> fits;      ///< one a group
  std::vector<double> by_block;  ///< held-out log-likelihood, groups after each other
  double gain = 0;               ///< over the baseline, nat
  std::vector<double> shaken;    ///< as by_block, beside a bias of every run; empty: not done
  std::string failure;           ///< why there is no fit; if not empty, the rest is unset
};

/// Runs that share coefficients: all, or those of one body.
std::vector<Group> groups_of(const BodyExperiment& experiment);

/// The baseline of the experiment, fitted. Where no start gives finite predictions,
/// `failure` says so. Throws InputError where a law of it cannot be had.
LawTrial fit_baseline(const BodyExperiment& experiment, std::vector<Group>& groups);

/// Whether a fitted baseline has more than twice the noise of the tracker that it has with laws
/// added: it attributes motion to noise.
bool absorbs_motion(const BodyModel& baseline, const BodyModel& with_laws);

/// The baseline where the tracker's noise is that of `best`, in groups whose own fit of the noise
/// is more than twice that: it attributed motion to noise.
LawTrial baseline_at_noise_of(const std::vector<Group>& groups, const LawTrial& baseline,
                              const LawTrial& best);

/// Laws alone that the recordings can have and the baseline does not.
std::vector<Candidate> single_laws(const BodyExperiment& experiment,
                                   const std::vector<Group>& groups);

/// The candidate added to `from` (a baseline, or an outcome that has all but its last law). Where
/// no start gives finite predictions, `failure` says so.
LawTrial fit_candidate(const std::vector<Group>& groups, const LawTrial& baseline,
                       const LawTrial& from, const Candidate& candidate);

/// Fits a trial again from the noise and the pushes of another: laws that it lacks may only have
/// led to better ones, and would gain by these. Whether it became better anywhere.
bool improve(const std::vector<Group>& groups, LawTrial& trial, const LawTrial& other);

/// All laws alone, best first; those without a fit are named in `failures`. Where the noise and the
/// pushes of one of the best make the baseline better, all are fitted once more from it. `before`
/// gets the name of each before its fit.
std::vector<LawTrial> fit_singles(const std::vector<Group>& groups, LawTrial& baseline,
                                  const std::vector<Candidate>& laws,
                                  const std::function<void(const std::string&)>& before,
                                  std::vector<std::string>& failures);

/// Best gains of single laws in experiments that the fitted baseline makes up, sorted. Large
/// recordings are cut: what chance gives hangs on the number of coefficients, not of samples. Kept
/// as they come. Throws Stopped.
std::vector<double> null_gains(const BodyExperiment& experiment, const std::vector<Group>& groups,
                               const LawTrial& baseline, int number, std::uint64_t seed,
                               const KeptRows& kept);

/// By how much `a` is better than `b` (nat), both by block, with its standard error from what
/// blocks differ in.
struct Difference {
  double value = 0, error = 0;
  bool distinguished() const;  ///< by two standard errors and two nat
};
Difference difference(const std::vector<double>& a, const std::vector<double>& b);

/// Whether runs of the same bodies, fitted one by one, agree in the coefficients of the last law:
/// squared differences from their mean by their standard errors, and how many are free.
struct Repeats {
  double square = 0;
  int free = 0;
  double factor() const;  ///< by which errors are too small (Birge's ratio); at least 1
  double z() const;       ///< of so much disagreement by chance (Wilson and Hilferty)
  std::string worst;      ///< group that disagrees most
};
Repeats repeats_of(const BodyExperiment& experiment, const std::vector<Group>& groups,
                   const LawTrial& outcome);

/// Fits an outcome once more with an unknown acceleration that lasts a whole run, as wrong scales,
/// clocks and releases give: laws that only such a fault could distinguish are then not
/// distinguished.
void fit_run_bias(const std::vector<Group>& groups, LawTrial& outcome);

/// rms difference of two outcomes' accelerations over the recorded motion, in units of the random
/// pushes of the first: below 1 the fits do not distinguish them.
double acceleration_difference(const std::vector<Group>& groups, const LawTrial& a,
                               const LawTrial& b);

/// Mean square of predictions over a quarter of a run from what the filter believed, per group
/// (m^2).
std::vector<double> far_errors(const std::vector<Group>& groups, const LawTrial& outcome);
/// The same of runs that the outcome's models simulate, the largest of nine simulations: what
/// process noise explains.
std::vector<double> largest_far_errors(const std::vector<Group>& groups, const LawTrial& outcome);

}  // namespace lilytank::bodies
