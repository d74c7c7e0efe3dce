#include <algorithm>
#include <cmath>

#include "bodies/verdict.hpp"

namespace lilytank {
namespace bodies {
namespace {

void sort_best_first(std::vector<LawTrial>& all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const LawTrial& a, const LawTrial& b) { return a.gain > b.gain; });
}

// Two laws of force together; curves stand alone, and laws that turn velocities say the same thing.
bool together(const Law& a, const Law& b) {
  const bool turns = a.variable() == "turn" && b.variable() == "turn";
  const bool pushes = a.variable() == "pair" && b.variable() == "pair";
  return &a != &b && !a.curve() && !b.curve() && !turns && !pushes;
}

// Pairs of the strongest laws with all others.
std::vector<std::pair<const LawTrial*, Candidate>> pairs_of(const std::vector<LawTrial>& singles) {
  constexpr std::size_t kStrongest = 3;
  std::vector<std::pair<const LawTrial*, Candidate>> out;
  std::vector<const LawTrial*> named;
  for (const LawTrial& o : singles) {
    if (!o.candidate.curve()) named.push_back(&o);
  }
  for (std::size_t i = 0; i < std::min(kStrongest, named.size()); ++i) {
    for (std::size_t j = i + 1; j < named.size(); ++j) {
      const Law *a = named[i]->candidate.laws[0], *b = named[j]->candidate.laws[0];
      if (together(*a, *b)) out.push_back({named[i], Candidate{{a, b}}});
    }
  }
  return out;
}

}  // namespace
}  // namespace bodies

std::optional<Diagnosis> diagnose_bodies(const BodyExperiment& e, const DiagnosisOptions& options) {
  using namespace bodies;
  const auto tell = [&](double done, const std::string& stage) {
    if (options.progress) options.progress(done, stage);
  };
  Job job{options.seed, options.stop, {}};
  Comparison c;
  c.experiment = &e, c.false_alarms = options.false_alarms, c.seed = options.seed;
  c.groups = groups_of(e);
  tell(0.01, "baseline");
  c.baseline = fit_baseline(e, c.groups);
  const std::vector<Candidate> laws = single_laws(e, c.groups);
  for (const Candidate& law : laws) {
    if (job.stopped()) return std::nullopt;
    tell(0.05 + 0.25 * static_cast<double>(c.singles.size()) / static_cast<double>(laws.size()),
         law.name());
    c.singles.push_back(fit_candidate(c.groups, c.baseline, c.baseline, law));
  }
  if (c.singles.empty())
    throw InputError("the baseline has every law that these recordings can have");
  sort_best_first(c.singles);
  const auto pairs = pairs_of(c.singles);
  for (const auto& [from, pair] : pairs) {
    if (job.stopped()) return std::nullopt;
    tell(0.3 + 0.3 * static_cast<double>(c.pairs.size()) / static_cast<double>(pairs.size()),
         pair.name());
    c.pairs.push_back(fit_candidate(c.groups, c.baseline, *from, pair));
  }
  sort_best_first(c.pairs);
  // A bias can be known only from several runs.
  if (e.runs.size() > 3) {
    for (std::vector<LawTrial>* all : {&c.singles, &c.pairs}) {
      for (std::size_t k = 0; k < all->size() && k < 6 && !job.stopped(); ++k)
        shake(c.groups, (*all)[k]);
    }
  }
  const int nulls = std::max(9, static_cast<int>(std::lround(4.9 * options.minutes)));
  job.progress = [&](double share) { tell(0.6 + 0.39 * share, "simulated baselines"); };
  c.nulls = null_gains(e, c.groups, c.baseline, nulls, job);
  if (job.stopped()) return std::nullopt;
  c.repeats = repeats_of(e, c.groups, c.best());
  c.far_before = far_errors(c.groups, c.baseline), c.far_after = far_errors(c.groups, c.best());
  return told(c);
}

}  // namespace lilytank
