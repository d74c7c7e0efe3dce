#include "proof/closed_loop.hpp"

#include <algorithm>

#include "finder/prepared_tank.hpp"
#include "finder/selection_report.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/random.hpp"
#include "scores/scores.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kMostProposals = 2;
constexpr double kLongestRepeat = 240;    // min
constexpr std::uint64_t kReferences = 4;  // simulations of the baseline
constexpr std::uint64_t kReferenceSeed = 17;
constexpr double kAmplitudePrior = 0.1;  // information of an amplitude, in sizes, that it is 0

// The candidates by the diagnosis and by all recordings since.
class Evidence {
 public:
  Evidence(const ScorePlan& plan, const OpenQuestion& question,
           const std::vector<Recording>& judged)
      : plan_(plan), question_(question), recordings_(judged), sums_(clear_sums(judged)) {
    before_ = gains();
    for (const EffectHypothesis& one : question.candidates) gain_.push_back(one.gain);
  }

  // In front, as further recordings of an experiment are.
  void add(std::vector<Recording> further) {
    const ScoreSums more = clear_sums(further);
    sums_.scores += more.scores, sums_.information += more.information;
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
  // The predictor's approximations bias scores: their mean in simulations of the baseline is
  // subtracted.
  ScoreSums clear_sums(const std::vector<Recording>& recordings) const {
    ScorePlan plan = plan_;
    plan.modules = std::max(plan.modules, identities_in(recordings));
    const std::vector<Effect> effects = effects_of(question_);
    ScoreSums out = score_sums(plan, recordings, effects);
    std::vector<RecordingShape> shapes;
    for (const Recording& one : recordings) {
      shapes.push_back(shape_of(one, plan.model.module.side)), shapes.back().starts.clear();
    }
    const Emulator baseline(plan.model, {}, shapes, {.moment_matched = false});
    for (std::uint64_t k = 0; k < kReferences; ++k) {
      const auto made = baseline.record({}, derived_seed(kReferenceSeed, k));
      if (made) out.scores -= score_sums(plan, *made, effects).scores / kReferences;
    }
    return out;
  }

  // Twice the log-likelihood ratio of each candidate alone, beside the other findings, to none.
  std::vector<double> gains() const {
    std::vector<double> out;
    Eigen::Index first = 0, all = 0;
    for (const EffectHypothesis& one : question_.candidates) all += std::ssize(one.effect.paths);
    for (const EffectHypothesis& one : question_.candidates) {
      const Eigen::Index count = std::ssize(one.effect.paths);
      std::vector<Eigen::Index> rows;
      for (Eigen::Index k = 0; k < count; ++k) rows.push_back(first + k);
      for (Eigen::Index k = all; k < sums_.scores.size(); ++k) rows.push_back(k);
      const bool one_sided = !one.effect.two_sided && count == 1;
      out.push_back(gain(rows, count, one_sided)), first += count;
    }
    return out;
  }

  // By how much the first `count` of these rows raise twice the log-likelihood beside the others.
  double gain(const std::vector<Eigen::Index>& rows, Eigen::Index count, bool one_sided) const {
    const auto n = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd normal = sums_.information(rows, rows);
    normal.diagonal().array() += kAmplitudePrior;
    const Eigen::MatrixXd known = plan_.nuisances_known();
    normal.bottomRightCorner(known.rows(), known.cols()) += known;
    const Eigen::VectorXd scores = sums_.scores(rows);
    const Eigen::VectorXd fit = solve_symmetric(normal, scores);
    if (one_sided && fit(0) < 0) return 0;
    const Eigen::MatrixXd rest = normal.bottomRightCorner(n - count, n - count);
    const Eigen::VectorXd beside = scores.tail(n - count);
    return scores.dot(fit) - beside.dot(solve_symmetric(rest, beside));
  }

  ScorePlan plan_;
  const OpenQuestion& question_;
  std::vector<Recording> recordings_;
  ScoreSums sums_;
  std::vector<double> before_, gain_;
};

// Recordings of Lilies that are compared together with those before.
const ProposedExperiment* best_of(const std::vector<ProposedExperiment>& all) {
  const auto found = std::ranges::find_if(
      all, [](const ProposedExperiment& one) { return !one.alone() && one.modules > 0; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

ProofLoop closed_loop(const ScorePlan& plan, const OpenQuestion& question,
                      const std::vector<Recording>& judged, const Proposals& proposals,
                      const FurtherRecording& further) {
  ProofLoop out;
  for (const EffectHypothesis& one : question.candidates) out.group.push_back(one.effect.name);
  Evidence proposed(plan, question, judged), repeated(plan, question, judged);
  int which = 0, modules = 0;
  double step = 0;
  while (out.texts.size() < kMostProposals && !out.split) {
    const auto all = proposals(proposed.recordings());
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
