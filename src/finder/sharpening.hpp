// The search for what the residuals are made of, with experiments of its own: fingerprints about
// what is found, other ranges, close calls, several effects at once.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "finder/diagnoser.hpp"

namespace lilytank {

// Fingerprints are learned at sizes that can just be seen well; what is far stronger is judged by
// experiments of its own strength.
class Diagnoser::Sharpening {
 public:
  Sharpening(Diagnoser& diagnoser, ModelSelection& selection, Alignment& alignment, Judged& judged,
             const Eigen::VectorXd& residual);

  // First those that might be it, then whatever leads, what is found and its rivals beside the
  // others.
  SelectedModel run();

 private:
  using Name = std::pair<int, int>;  // effect and shape
  using Suspect = std::pair<const Name, SingleFit>;
  // Of the spread of experiments, that the likeliest may be off.
  static constexpr double kBeside = 0.5;

  // Fingerprints (sharpen.cpp).

  void find_homes();
  Name name_of(const EffectFit& f) const;
  // Forgets the experiments with the effects of a family: they are others now.
  void forget(int family);
  // The sharpest that there is.
  Fingerprint fingerprint(const EffectFit& f);
  // Learns one about the strength that was found.
  void sharpen(EffectFit f, int experiments = Atlas::kAbout);
  // Where further experiments with an effect are to be.
  Eigen::VectorXd halfway(const EffectFit& f, const Fingerprint& from);
  // Learns those that the explanation asks for, until it asks for none.
  SelectedModel settled(SelectedModel e);
  // Where its first experiments are to be.
  EffectFit begun(EffectFit f);
  // What the filter says of an effect or a curve in the very recordings; asked once.
  const JointAmplitudes& own(const EffectFit& f, const Effect& effect);
  // The same where a linear estimate is not all that is known.
  JointAmplitudes scanned_or(JointAmplitudes linear, const Effect& effect) const;
  // The effects that the filter says most clearly, by their amplitudes in the very recordings.
  std::vector<EffectFit> clearest();
  // Whether its fingerprint is not one of its strength.
  bool blunt(const EffectFit& f) const;
  // What is found should be where its experiments were, not beside them. `far`: in their spread.
  bool off_centre(const EffectFit& f, double far = 1) const;
  // What is to be sharpened next, if anything.
  std::optional<EffectFit> next_after(const SelectedModel& e);

  // What is told (likeliest.cpp).

  // What alone, by its own scatter, is most likely there. The scatter of ten experiments leaves a
  // doubt uncertain, and a curve has more ways to be near: names come first.
  std::optional<EffectFit> likeliest(bool effects_only = false,
                                     const std::string& variable = "") const;
  // Judged by the scatter of the experiments with what is likeliest. These are to be where it is,
  // and so are those of the likeliest name: off it, a curve would seem to fit better.
  SelectedModel explained();
  // What adds up from others has to be likelier than an effect that is; curves can do so much that
  // they come after names.
  SelectedModel explained_by(const ModelSelection& selection) const;
  // By the wide scatter of experiments with an effect there may seem to be nothing; but without an
  // effect there is no such scatter. What hardly speaks even so is not told.
  SelectedModel something(const ModelSelection& selection, const EffectFit& likely) const;
  // Whether a curve is left that is not much weaker than what was found: more than what a
  // fingerprint is wrong by.
  bool leaves_curve(const ModelSelection& selection, const SelectedModel& e) const;
  bool is_found(const EffectFit& f, const SelectedModel& e) const;

  // Further experiments (refine.cpp).

  // Beside a strong effect, the place of a stream and the ranges of forces are not where they seem
  // to be without it. True if one of them is elsewhere.
  bool rescan(const SelectedModel& e);
  bool rescan_stream(const SelectedModel& e, const Effect& stream);
  // The range of this effect.
  bool rescan(const SelectedModel& e, const Effect& scanned);
  // Scores beside all strong ones but those of the law that is scanned, and curves that may stand
  // for it.
  ScorePlan beside(const SelectedModel& e, const Effect& scanned) const;
  // Where the likeliest name leaves something, its law may have another range, time or length than
  // the experiments with it had; so may that of a name of the same variable as a curve. Each is
  // sought up and down until it fits no better.
  bool refine(const SelectedModel& e);
  std::vector<EffectFit> refinable(const SelectedModel& e) const;
  bool refined(const EffectFit& name, const FitParameter& p);
  // Where the likeliest name and the likeliest curve are about as likely, more experiments with
  // each are to tell: by ten a doubt is known to some ten only.
  bool close_call();
  // Where something is left beside what is likeliest, more experiments with that are to tell: by
  // ten its scatter is known along ten directions only. True if they were made.
  bool made_sure(const SelectedModel& e);
  // Whether the law fits better with this parameter times a factor; if not, all is as before.
  bool fits_better(const EffectFit& name, const FitParameter& p, double factor);
  // Several effects need not add up: modules that one holds together another cannot move apart.
  // What they do at once is simulated as well.
  SelectedModel met(SelectedModel e);
  // By experiments with all of them, about these amplitudes.
  Fingerprint simulated(const std::vector<EffectFit>& found, const std::string& name);

  Diagnoser& of_;
  ModelSelection& selection_;
  Alignment& alignment_;
  Judged& judged_;
  const Eigen::VectorXd& residual_;
  double nothing_;                       // squared distance of nothing, by the scatter of nulls
  std::map<int, int> home_;              // the effect that stands for all of its family
  std::map<Name, JointAmplitudes> own_;  // what the filter says of effects
  std::map<Name, Fingerprint> known_;    // fingerprints about found amplitudes
  LearnedFingerprints learned_;          // all that there were
  std::map<Name, SingleFit> alone_;
  std::set<Name> centred_;
  std::map<Name, int> moved_;             // how often experiments of its own were made anew
  std::map<Name, Eigen::VectorXd> step_;  // by which they moved last
  int tries_ = 0;
};

}  // namespace lilytank
