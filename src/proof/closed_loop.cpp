#include "proof/closed_loop.hpp"

#include <algorithm>

#include "finder/selection_report.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kMostProposals = 2;
constexpr double kLongestRepeat = 240;  // min

// The candidates by the diagnosis and by all recordings since.
class Evidence {
 public:
  Evidence(const PreparedTank& tank, const OpenQuestion& question,
           const std::vector<Recording>& judged)
      : plan_(tank.ensemble.plan()), question_(question), recordings_(judged), before_(gains()) {
    for (const EffectHypothesis& one : question.candidates) gain_.push_back(one.gain);
  }

  // In front, as further recordings of an experiment are.
  void add(std::vector<Recording> further) {
    recordings_.insert(recordings_.begin(), std::make_move_iterator(further.begin()),
                       std::make_move_iterator(further.end()));
    const std::vector<double> now = gains();
    for (std::size_t k = 0; k < now.size(); ++k) {
      gain_[k] = question_.candidates[k].gain + now[k] - before_[k];
    }
  }

  std::size_t best() const {
    return static_cast<std::size_t>(std::max_element(gain_.begin(), gain_.end()) - gain_.begin());
  }
  bool split() const {
    const double most = gain_[best()];
    return std::count_if(gain_.begin(), gain_.end(),
                         [&](double gain) { return most - gain < kSameGain; }) == 1;
  }
  const std::vector<Recording>& recordings() const { return recordings_; }

 private:
  // On all recordings, each candidate alone beside the other findings.
  std::vector<double> gains() {
    std::vector<Effect> effects;
    for (const EffectHypothesis& one : question_.candidates) effects.push_back(one.effect);
    plan_.beside.clear();
    for (const EffectHypothesis& one : question_.beside) plan_.beside.push_back(one.effect);
    plan_.modules = std::max(plan_.modules, identities_in(recordings_));
    std::vector<double> out;
    for (const JointAmplitudes& one : joint_amplitudes(plan_, recordings_, effects)) {
      const Effect& effect = effects[out.size()];
      const bool absent = !effect.two_sided && one.estimate.size() == 1 && one.estimate(0) < 0;
      out.push_back(absent ? 0 : one.gain);
    }
    return out;
  }

  ScorePlan plan_;
  const OpenQuestion& question_;
  std::vector<Recording> recordings_;
  std::vector<double> before_, gain_;
};

// Recordings of Lilies that are compared together with those before.
const ProposedExperiment* best_of(const std::vector<ProposedExperiment>& all) {
  const auto found = std::ranges::find_if(
      all, [](const ProposedExperiment& one) { return !one.alone() && one.modules > 0; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

ProofLoop closed_loop(PreparedTank& tank, const OpenQuestion& question,
                      const std::vector<Recording>& judged, const FurtherRecording& further) {
  ProofLoop out;
  for (const EffectHypothesis& one : question.candidates) out.group.push_back(one.effect.name);
  Evidence proposed(tank, question, judged), repeated(tank, question, judged);
  int which = 0, modules = 0;
  double step = 0;
  while (out.texts.size() < kMostProposals && !out.split) {
    const auto all = proposals(tank, question, proposed.recordings());
    const ProposedExperiment* best = best_of(all);
    if (best == nullptr) return out;
    out.texts.push_back(best->text());
    if (step == 0) {
      step = best->minutes;
      for (const ProposedExperiment& one : all) modules = one.repeats ? one.modules : modules;
    }
    proposed.add(further(best->modules, best->minutes, which++));
    out.minutes += best->minutes;
    out.split = proposed.split(), out.left = out.group[proposed.best()];
  }
  while (!out.repeat_split && out.repeat_minutes < kLongestRepeat) {
    repeated.add(further(modules, step, which++));
    out.repeat_minutes += step;
    out.repeat_split = repeated.split(), out.repeat_left = out.group[repeated.best()];
  }
  return out;
}

}  // namespace lilytank
