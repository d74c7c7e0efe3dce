// The search for what the residuals are made of, with experiments of its own: fingerprints about
// what is found, other ranges, close calls, several effects at once.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "finder/clear_place.hpp"
#include "finder/found_effect.hpp"
#include "finder/model_selection.hpp"
#include "finder/score_sensitivity.hpp"

namespace lilytank {

/// Response of one effect or shape, from experiments simulated about its estimated amplitudes.
struct RefinedCandidate {
  Fingerprint fingerprint;  ///< about these amplitudes
  SingleFit alone;          ///< by it and the scatter of its experiments
  Eigen::VectorXd step;     ///< last change of the amplitudes; empty before that
  int moves = 0;            ///< number of times that its experiments were moved
  bool centred = false;     ///< its experiments were repeated at the estimate
};

/// A selection for one experiment's recordings and what it rests on.
struct RefinedSelection {
  SelectedModel model;
  ModelSelection selection;
  ScoreDetails details;
  /// The only finding, where scores of the plan do not show it and its place does, before other
  /// effects that are as clear, by their likelihood.
  std::optional<PlaceFinding> by_place = {};
  /// Where the first finding is a fault of the control: others that many experiments of their own
  /// do not tell from it.
  std::vector<EffectFit> alike = {};
};

/// What the search is for and with; all must outlive it.
struct RefinementInput {
  ReferenceEnsemble& ensemble;
  ScoreSensitivity& sensitivity;  ///< of the recordings
  const Vectors& observed;
  const Model& calibrated;  ///< the baseline with the parameters calibrated to the recordings
  const Eigen::VectorXd& residual;
  double baseline_misfit;  ///< of the residual, by the scatter of nulls
  double false_alarms;     ///< false-positive rate of null experiments
  int threads;
};

/// The selection by experiments of its own, unless `start` explains the residual plainly: by one
/// effect of a size that fingerprints were learned at, without a rival; or finds nothing, and no
/// place of the tank shows more than null experiments do. Throws Stopped.
RefinedSelection refined_selection(const RefinementInput& input, RefinedSelection start);

// Fingerprints are learned at sizes that can just be seen well; what is far stronger is judged by
// experiments of its own strength.
class Refinement {
 public:
  /// `start`: the selection and details of the recordings, with their scans.
  Refinement(const RefinementInput& input, const RefinedSelection& start);

  /// First the candidates that may be it, then whatever leads, what is found and its rivals beside
  /// the others. `by_place`: what the scan of places found, if that is why. Throws Stopped.
  RefinedSelection run(const std::optional<PlaceFinding>& by_place = {});

 private:
  using Id = std::pair<int, int>;  // effect and shape; of a family the effect that stands for it

  // All that a trial changes, and that is as before if it is rejected.
  struct State {
    ModelSelection selection;
    ScoreDetails details;
    std::map<int, int> home;  // the effect that stands for all of its family
    std::map<Id, RefinedCandidate> refined;
  };

  // Fingerprints (refinement.cpp).

  void find_homes();
  Id id_of(const EffectFit& f) const;
  static EffectFit fit_with(const Id& id, const Eigen::VectorXd& amplitudes);
  const Effect& effect(const Id& id) const { return effect_in(plan_, fit_with(id, {})); }
  Effect found_effect(const EffectFit& f) const {
    return lilytank::found_effect(plan_, f, state_.details);
  }
  std::string stage_name(const EffectFit& f) const {
    return lilytank::stage_name(plan_, f, state_.details);
  }
  const RefinedCandidate* refined(const EffectFit& f) const;
  // Forgets the experiments with the effects of a family: their place or range is another one now.
  void forget(int family);
  // By the scan of places alone: where the recordings are likeliest with it.
  EffectFit fit_at_place(const EffectFit& clear);
  // Whether the scores show nothing else, and that not significantly.
  bool shows_only(const SelectedModel& m, const EffectFit& f) const;
  // With the effects by the likelihood at their best places.
  PlaceFinding likeliest_first(PlaceFinding of) const;
  // About found amplitudes where there is one, else as learned first.
  Fingerprint fingerprint(const EffectFit& f);
  // Experiments about the amplitudes that were found, and the fingerprint by them.
  void refine_fingerprint(EffectFit f, int experiments = ReferenceEnsemble::kAbout);
  // Where further experiments with an effect are to be.
  Eigen::VectorXd halfway(const EffectFit& f, const Fingerprint& from);
  // Refines fingerprints until the selection needs no more.
  SelectedModel settled(SelectedModel m);
  // Where its first experiments are to be.
  EffectFit first_guess(EffectFit f);
  // The filter's estimate of an effect or a curve in the very recordings; made once.
  const JointAmplitudes& filtered(const EffectFit& f, const Effect& effect);
  // The same where a scan knows more than a linear estimate.
  JointAmplitudes scanned_or(JointAmplitudes linear, const Effect& effect) const;
  // The effects that the filter shows most clearly, by their amplitudes in the very recordings.
  std::vector<EffectFit> clearest();
  // Whether its fingerprint is not one of its strength.
  bool needs_relinearization(const EffectFit& f) const;
  // Whether what is found is beside its experiments. `far`: in their spread.
  bool off_centre(const EffectFit& f, double far = 1) const;
  // What is to be refined next, if anything.
  std::optional<EffectFit> next_after(const SelectedModel& m);

  // Selection (refined_selection.cpp).

  // What alone, by its own scatter, is most likely there. The scatter of ten experiments leaves a
  // deviance uncertain, and a curve has more ways to be near: names come first.
  std::optional<EffectFit> likeliest(bool effects_only = false,
                                     const std::string& variable = "") const;
  // Judged by the scatter of the experiments with the likeliest. These are to be where it is, and
  // so are those of the likeliest name: off it, a curve would seem to fit better.
  SelectedModel selected();
  // What adds up from others has to be likelier than an effect that is; curves can do so much that
  // they come after names.
  SelectedModel selected_by(const ModelSelection& selection) const;
  // The wide scatter of experiments with an effect may hide everything; but without an effect there
  // is no such scatter. What is hardly significant even so is not reported.
  SelectedModel at_least(const ModelSelection& selection, const EffectFit& likely) const;
  // Whether a curve remains that is not much weaker than what was found: more than what a
  // fingerprint is wrong by.
  bool leaves_curve(const ModelSelection& selection, const SelectedModel& m) const;
  bool is_found(const EffectFit& f, const SelectedModel& m) const;

  // Further experiments (refinement_trials.cpp).

  // Beside a strong effect, the place of a stream and the ranges of forces are not where they seem
  // to be without it. True if one of them is elsewhere.
  bool rescan(const SelectedModel& m);
  bool rescan_place(const SelectedModel& m, const Effect& effect);
  // The range of this effect.
  bool rescan(const SelectedModel& m, const Effect& scanned);
  // Scores beside all strong ones but those of the law that is scanned, and curves that may stand
  // for it.
  ScorePlan beside(const SelectedModel& m, const Effect& scanned) const;
  // Where the likeliest name leaves something, its law may have another range, time or length than
  // the experiments with it had; so may that of a name of the same variable as a curve. Each is
  // sought up and down until it fits no better.
  bool refine_ranges(const SelectedModel& m);
  std::vector<EffectFit> refinable(const SelectedModel& m) const;
  bool refine_range(const EffectFit& name, const FitParameter& p);
  // Where the likeliest name and the likeliest curve are about as likely, more experiments with
  // each decide: ten leave a deviance uncertain by about ten.
  bool close_call();
  // Faults of the control that are about as likely are decided likewise, each about its own
  // estimate: their statistics saturate, so that the nearest experiments would win.
  bool close_faults();
  // Of these, those that are not less likely than the first finding beyond chance.
  std::vector<EffectFit> alike_faults(const SelectedModel& m) const;
  // Where something remains beside the likeliest, more experiments with it follow: ten show its
  // scatter along ten directions only. True if they were made.
  bool made_sure(const SelectedModel& m);
  // Whether the law fits better with this parameter times a factor; if not, the state is as before.
  bool fits_better(const EffectFit& name, const FitParameter& p, double factor);
  // Several effects need not add up: modules that one holds together another cannot move apart.
  // What they do at once is simulated as well.
  SelectedModel with_interactions(SelectedModel m);
  // By experiments with all of them, about these amplitudes.
  Fingerprint simulated(const std::vector<EffectFit>& found, const std::string& name);

  ReferenceEnsemble& ensemble_;
  const ScorePlan& plan_;
  ScoreSensitivity& sensitivity_;
  const Eigen::VectorXd& residual_;
  const Eigen::VectorXd calibrated_;  // the recordings' parameters by the baseline
  const Model& scan_model_;           // the baseline with these, as errors of them shift places
  const double baseline_misfit_;
  const int threads_;
  State state_;
  LearnedFingerprints learned_;  // of all experiments that there were
  std::map<Id, JointAmplitudes> filtered_;
  int tries_ = 0;
};

}  // namespace lilytank
