#include "finder/next_experiment.hpp"

#include <algorithm>
#include <array>

#include "lilytank/emulator.hpp"
#include "lilytank/random.hpp"
#include "lilytank/study.hpp"
#include "scores/scores.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::array kMinutes{4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0, 60.0};
constexpr double kPowers[] = {0.7, 1.4};          // of the pumps
constexpr double kFullest = 0.25;                 // share of the water's surface under modules
constexpr double kModuleSeconds = 15 * 60;        // simulated, summed over modules
constexpr double kShortest = 60, kLongest = 300;  // s simulated
constexpr double kLeastInformation = 0.5;         // nat: less in an hour is not proposed
constexpr double kAmplitudeKnown = 1e-4;          // prior information of an amplitude, in sizes

// Of the last recording: further ones come before it.
int usual_modules(const std::vector<Recording>& recordings) {
  int most = 1;
  for (const int seen : seen_by_frame(recordings.back())) most = std::max(most, seen);
  return most;
}

double minutes_of(const std::vector<Recording>& recordings) {
  double out = 0;
  for (const Recording& one : recordings) out += one.frames / one.rate / 60;
  return out;
}

// The experiments that are compared; what they show and their minutes are still open.
std::vector<ProposedExperiment> experiments(const RecordedSoFar& so_far) {
  const int modules = usual_modules(so_far.fitted);
  const Model& model = so_far.plan.model;
  const double side = model.module.side / model.tank.radius;
  std::vector<int> counts{modules};
  for (const int count : {1, modules / 2, 2 * modules}) {
    const bool known = std::find(counts.begin(), counts.end(), count) != counts.end();
    if (count > 0 && !known && count * side * side < kFullest * kPi) counts.push_back(count);
  }
  std::vector<ProposedExperiment> out;
  for (const int count : counts) {
    ProposedExperiment one;
    one.modules = count, one.repeats = count == modules;
    out.push_back(one);
  }
  if (so_far.ball_minutes <= 0) return out;
  for (const double power : kPowers) {
    ProposedExperiment one;
    one.modules = modules, one.power = power, one.balls = so_far.balls;
    out.push_back(one);
  }
  ProposedExperiment balls;
  balls.balls = so_far.balls;
  out.push_back(balls);
  return out;
}

Model with_hypothesis(const Model& model, const EffectHypothesis& one) {
  std::vector<double> amplitudes;
  for (std::size_t c = 0; c < one.effect.sizes.size(); ++c) {
    amplitudes.push_back(one.effect.value(model, c, one.amplitudes(static_cast<Eigen::Index>(c))));
  }
  return with_effect(model, one.effect, amplitudes);
}

// Information of the amplitudes and nuisances, by effects_of(), in a minute of Lilies; empty if the
// simulation diverges.
Matrix information_per_minute(const RecordedSoFar& so_far, const OpenQuestion& question,
                              const ProposedExperiment& of, std::size_t truth, std::uint64_t seed) {
  ScorePlan plan = so_far.plan;
  plan.modules = of.modules, plan.model.flow.K_v *= of.power;
  const Recording& like = so_far.fitted.front();
  const double seconds = std::clamp(kModuleSeconds / of.modules, kShortest, kLongest);
  RecordingShape shape;
  shape.name = like.name, shape.bodies = of.modules, shape.rate = like.rate;
  shape.frames = static_cast<int>(seconds * like.rate) + 1;
  Model model = with_hypothesis(plan.model, question.candidates[truth]);
  for (const EffectHypothesis& one : question.beside) model = with_hypothesis(model, one);
  const auto recorded = Emulator(model, {}, {shape}).record({}, seed);
  if (!recorded) return {};
  return score_sums(plan, *recorded, effects_of(question)).information * (60 / seconds);
}

// Where amplitudes of candidates stand among rows.
struct Rows {
  Eigen::Index first = 0, count = 0;
};

class Comparison {
 public:
  Comparison(const RecordedSoFar& so_far, const OpenQuestion& question)
      : so_far_(so_far),
        question_(question),
        old_(score_sums(so_far.plan, so_far.fitted, effects_of(question)).information),
        minutes_(minutes_of(so_far.fitted)) {
    for (const EffectHypothesis& one : question.candidates) {
      const Eigen::Index at = rows_.empty() ? 0 : rows_.back().first + rows_.back().count;
      rows_.push_back({at, static_cast<Eigen::Index>(one.effect.paths.size())});
    }
  }

  // The minutes, from the list, that give what is wanted, and what they give. `rates`: information
  // per minute under each candidate; none if there are only balls.
  void fill(ProposedExperiment& of, const std::vector<Matrix>& rates) const {
    const double balls_per_lily = so_far_.ball_minutes / minutes_;
    for (const double minutes : kMinutes) {
      of.minutes = of.modules > 0 ? minutes : 0;
      of.ball_minutes = of.modules == 0 ? minutes : of.alone() ? minutes * balls_per_lily : 0;
      of.information = HUGE_VAL;
      for (std::size_t a = 0; a < rows_.size(); ++a) {
        for (std::size_t b = 0; b < rows_.size(); ++b) {
          if (a == b) continue;
          const double gained = gain(of, rates.empty() ? Matrix() : rates[a], a, b);
          if (gained < of.information) of.information = gained, of.pair = pair_of(a, b);
        }
      }
      if (of.information >= kWantedInformation) return;
    }
  }

 private:
  std::string pair_of(std::size_t a, std::size_t b) const {
    const auto name = [&](std::size_t k) { return question_.candidates[k].effect.name; };
    return name(std::min(a, b)) + " or " + name(std::max(a, b));
  }

  // Nat by which further recordings are expected to raise the log-likelihood ratio of a to b if a
  // is there.
  double gain(const ProposedExperiment& of, const Matrix& rate, std::size_t a,
              std::size_t b) const {
    const Matrix known = so_far_.plan.nuisances_known();
    if (of.alone()) return distinguished(of.minutes * rate, known, a, b);
    const double before = distinguished(old_, known, a, b);
    if (of.modules == 0) return distinguished(old_, with_balls(of.ball_minutes), a, b) - before;
    return distinguished(old_ + of.minutes * rate, known, a, b) - before;
  }

  // The balls' part of the nuisances' variance falls with their time.
  Matrix with_balls(double more) const {
    const Matrix all = symmetric_inverse(so_far_.plan.nuisances_known());
    const Matrix rest = symmetric_inverse(so_far_.known_with_all_balls);
    const double left = so_far_.ball_minutes / (so_far_.ball_minutes + more);
    return symmetric_inverse(Matrix(rest + left * (all - rest)));
  }

  // Expected log-likelihood ratio of a, at its amplitudes, to b at the amplitudes that fit best,
  // with the effects beside and the nuisances fitted as well.
  double distinguished(const Matrix& information, const Matrix& known, std::size_t a,
                       std::size_t b) const {
    std::vector<Eigen::Index> fitted;
    for (Eigen::Index k = 0; k < rows_[b].count; ++k) fitted.push_back(rows_[b].first + k);
    for (Eigen::Index k = rows_.back().first + rows_.back().count; k < information.rows(); ++k) {
      fitted.push_back(k);
    }
    Matrix normal = information(fitted, fitted);
    normal.diagonal().array() += kAmplitudeKnown;
    normal.bottomRightCorner(known.rows(), known.cols()) += known;
    std::vector<Eigen::Index> own;
    for (Eigen::Index k = 0; k < rows_[a].count; ++k) own.push_back(rows_[a].first + k);
    const Vector& size = question_.candidates[a].amplitudes;
    const Vector shared = information(fitted, own) * size;
    const double left = size.dot(Matrix(information(own, own)) * size) -
                        shared.dot(solve_symmetric(normal, shared));
    return 0.5 * std::max(0.0, left);
  }

  const RecordedSoFar& so_far_;
  const OpenQuestion& question_;
  std::vector<Rows> rows_;  // of the candidates
  Matrix old_;
  double minutes_;
};

}  // namespace

std::vector<Effect> effects_of(const OpenQuestion& question) {
  std::vector<Effect> out;
  for (const auto* all : {&question.candidates, &question.beside}) {
    for (const EffectHypothesis& one : *all) out.push_back(one.effect);
  }
  return out;
}

std::vector<ProposedExperiment> propose_experiments(const RecordedSoFar& so_far,
                                                    const OpenQuestion& question,
                                                    std::uint64_t seed, int threads) {
  const std::size_t candidates = question.candidates.size();
  if (candidates < 2) return {};
  std::vector<ProposedExperiment> all = experiments(so_far);
  const Comparison comparison(so_far, question);
  std::vector<std::vector<Matrix>> rates(all.size(), std::vector<Matrix>(candidates));
  for_each_world(static_cast<int>(all.size() * candidates), threads, [&](int i) {
    const auto k = static_cast<std::size_t>(i) / candidates;
    const auto truth = static_cast<std::size_t>(i) % candidates;
    if (all[k].modules == 0) return;
    rates[k][truth] =
        information_per_minute(so_far, question, all[k], truth, derived_seed(seed, k));
  });
  std::vector<ProposedExperiment> out;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto diverged = [](const Matrix& rate) { return rate.size() == 0; };
    if (all[k].modules == 0) rates[k].clear();
    if (std::any_of(rates[k].begin(), rates[k].end(), diverged)) continue;
    comparison.fill(all[k], rates[k]);
    out.push_back(all[k]);
  }
  const auto per_minute = [](const ProposedExperiment& of) {
    return of.information / of.all_minutes();
  };
  // The first one repeats, unless it diverged.
  const double repeated = !out.empty() && out.front().repeats ? per_minute(out.front()) : NAN;
  for (ProposedExperiment& of : out) of.relative = per_minute(of) / repeated;
  std::erase_if(out, [](const auto& of) { return of.information < kLeastInformation; });
  std::stable_sort(out.begin(), out.end(),
                   [&](const auto& a, const auto& b) { return per_minute(a) > per_minute(b); });
  return out;
}

}  // namespace lilytank
