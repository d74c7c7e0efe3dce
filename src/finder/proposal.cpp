#include "finder/proposal.hpp"

#include <algorithm>

#include "finder/found_effect.hpp"
#include "finder/next_experiment.hpp"
#include "finder/nuisances.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kMostCompared = 4;
constexpr std::uint64_t kProposalSeed = 900, kCertainSeed = 901;

// Of these fits those whose force the filter predicts.
std::vector<EffectHypothesis> predictable(const ScorePlan& plan, const Judged& judged,
                                          std::span<const EffectFit> fits) {
  std::vector<EffectHypothesis> out;
  for (const EffectFit& fit : fits) {
    EffectHypothesis one{found_effect(plan, fit, judged.details), fit.amplitudes};
    const bool there = one.amplitudes.size() > 0 && one.amplitudes.cwiseAbs().maxCoeff() > 0;
    if (one.effect.mean_force && one.effect.term != nullptr && there) out.push_back(one);
  }
  return out;
}

OpenQuestion question_of(const ScorePlan& plan, const Judged& judged, Verdict verdict) {
  OpenQuestion out;
  if (verdict == Verdict::missing && !judged.selected.found.empty()) {
    out.beside = predictable(plan, judged, std::span(judged.selected.found).subspan(1));
  }
  if (verdict == Verdict::missing || verdict == Verdict::undecided) {
    out.candidates = predictable(plan, judged, judged.open);
  }
  if (out.candidates.size() > kMostCompared) out.candidates.resize(kMostCompared);
  return out;
}

}  // namespace

std::vector<ProposedExperiment> next_experiments(PreparedTank& tank, const Judged& judged,
                                                 const std::vector<Recording>& fitted,
                                                 const Diagnosis& diagnosis) {
  const ScorePlan& plan = tank.ensemble.plan();
  const OpenQuestion question = question_of(plan, judged, diagnosis.verdict);
  if (question.candidates.size() < 2) return {};
  const DiagnosisOptions& options = tank.setup.options;
  RecordedSoFar so_far{plan, fitted, 0, 0, {}};
  if (tank.maps.uncertain()) {
    for (const Recording& one : tank.setup.calibration.balls) {
      so_far.ball_minutes += one.frames / one.rate / 60;
      const std::vector<int> seen = seen_by_frame(one);
      for (const int balls : seen) so_far.balls = std::max(so_far.balls, balls);
    }
    so_far.known_with_all_balls = tank.setup.stages.matrix(
        "nuisances, certain flow", static_cast<Eigen::Index>(nuisance_count()), [&] {
          return nuisances_known(plan.model, FlowMaps(tank.maps.best()),
                                 derived_seed(options.seed, kCertainSeed), options.threads);
        });
  }
  return propose_experiments(so_far, question, derived_seed(options.seed, kProposalSeed),
                             options.threads);
}

}  // namespace lilytank
