#include "finder/proposal.hpp"

#include <algorithm>

#include "finder/found_effect.hpp"
#include "finder/next_experiment.hpp"
#include "lilytank/random.hpp"
#include "scores/nuisances.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kMostCompared = 4;
constexpr std::uint64_t kProposalSeed = 900, kCertainSeed = 901;

// Whether the filter predicts its force.
bool predictable(const EffectHypothesis& one) {
  return one.effect.mean_force && one.effect.term != nullptr && one.amplitudes.size() > 0 &&
         one.amplitudes.cwiseAbs().maxCoeff() > 0;
}

std::vector<EffectHypothesis> hypotheses(const ScorePlan& plan, const Judged& judged,
                                         std::span<const EffectFit> fits) {
  std::vector<EffectHypothesis> out;
  for (const EffectFit& fit : fits) {
    out.push_back({found_effect(plan, fit, judged.details), fit.amplitudes, fit.gain});
  }
  return out;
}

}  // namespace

OpenQuestion open_question(const ScorePlan& plan, const Judged& judged, Verdict verdict) {
  OpenQuestion out;
  if (verdict == Verdict::missing && !judged.selected.found.empty()) {
    out.beside = hypotheses(plan, judged, std::span(judged.selected.found).subspan(1));
  }
  if (verdict == Verdict::missing || verdict == Verdict::undecided) {
    out.candidates = hypotheses(plan, judged, judged.open);
  }
  if (!out.candidates.empty() && !predictable(out.candidates.front())) return {};
  for (auto* all : {&out.candidates, &out.beside}) {
    std::erase_if(*all, [](const EffectHypothesis& one) { return !predictable(one); });
  }
  if (out.candidates.size() > kMostCompared) out.candidates.resize(kMostCompared);
  return out;
}

std::vector<ProposedExperiment> proposals(PreparedTank& tank, const OpenQuestion& question,
                                          const std::vector<Recording>& fitted) {
  if (question.candidates.size() < 2) return {};
  ScorePlan plan = tank.ensemble.plan();
  plan.modules = std::max(plan.modules, identities_in(fitted));
  const DiagnosisOptions& options = tank.setup.options;
  RecordedSoFar so_far{plan, fitted, 0, 0, {}};
  if (tank.maps.uncertain()) {
    for (const Recording& one : tank.setup.calibration.balls) {
      so_far.ball_minutes += one.frames / one.rate / 60;
      const std::vector<int> seen = seen_by_frame(one);
      for (const int balls : seen) so_far.balls = std::max(so_far.balls, balls);
    }
    so_far.known_with_all_balls = plan.nuisances->known_for(
        FlowMaps(tank.maps.best()), derived_seed(options.seed, kCertainSeed), options.threads);
  }
  return propose_experiments(so_far, question, derived_seed(options.seed, kProposalSeed),
                             options.threads);
}

}  // namespace lilytank
