#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bodies/checks.hpp"
#include "bodies/verdict.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/state.hpp"
#include "statistics/largest_first.hpp"
#include "study/kept_rows.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace bodies {
namespace {

constexpr std::size_t kStrongest = 3;  // laws, and groups of laws, that others are added to

// Whether two laws are combined: curves are not, nor two laws that rotate velocities or two of
// pairs of bodies, which are nearly equivalent.
bool together(const Law& a, const Law& b) {
  const bool turns = a.variable == "turn" && b.variable == "turn";
  const bool pushes = a.variable == "pair" && b.variable == "pair";
  return &a != &b && !a.curve && !b.curve && !turns && !pushes;
}

// Pairs of the strongest laws with all others.
std::vector<std::pair<const LawTrial*, Candidate>> pairs_of(const std::vector<LawTrial>& singles) {
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

std::uint64_t identity_of(const BodyExperiment& e, const DiagnosisOptions& options) {
  Fnv hash;
  hash.add("5 " + e.name + " " + e.unit + " " + std::to_string(options.seed));
  hash.add(std::vector<double>{double(e.dimensions), e.noise, double(e.coefficients),
                               double(e.masses), e.turning, double(e.latitude),
                               double(e.current[0]), double(e.current[1]), double(e.wind[0]),
                               double(e.wind[1]), e.density, options.minutes});
  for (const BaselineLaw& law : e.baseline) {
    hash.add(law.law + " " + shortest(law.value) + (law.fit ? " fit" : ""));
  }
  for (const BodyRun& run : e.runs) {
    hash.add(run.name + (run.held_out ? " held out" : ""));
    for (const auto* of : {&run.mass, &run.radius, &run.time, &run.position, &run.drivers}) {
      hash.add(*of);
    }
  }
  return hash.value();
}

// The reported laws with a rotation of any rate instead of the law that turns velocities; nothing
// where none does, or one of any rate is reported, or the rotation has no fit.
std::optional<LawTrial> with_free_rotation(const Comparison& c) {
  Candidate freed;
  bool turns = false;
  for (const Law* law : c.reported->candidate.laws) {
    if (law->name == "spin_lift") return std::nullopt;
    if (law->variable == "turn")
      turns = true;
    else
      freed.laws.push_back(law);
  }
  if (!turns) return std::nullopt;
  const LawTrial* from = c.outcome_of(freed.laws);
  freed.laws.push_back(find_law("rotation"));
  if (from == nullptr) return std::nullopt;
  LawTrial out = fit_candidate(c.groups, c.baseline, *from, freed);
  return out.failure.empty() ? std::optional(std::move(out)) : std::nullopt;
}

// Fits laws one after the other.
class Trials {
 public:
  Trials(const BodyExperiment& e, const DiagnosisOptions& options, Comparison& c)
      : experiment_(e), options_(options), c_(c) {}
  void run() {
    options_.report(0.01, "baseline");
    c_.baseline = fit_baseline(experiment_, c_.groups);
    if (!c_.baseline.failure.empty())
      throw InputError("experiment " + experiment_.name + ": " + c_.baseline.failure);
    singles();
    pairs();
    nulls();
    c_.select();
    if (c_.reported->candidate.laws.size() == 2) triples();
  }

 private:
  // A law without a fit is not compared with any other.
  void keep(LawTrial trial, std::vector<LawTrial>& to) {
    if (trial.failure.empty())
      to.push_back(std::move(trial));
    else
      c_.failures.push_back(std::move(trial.failure));
  }

  void singles() {
    const std::vector<Candidate> laws = single_laws(experiment_, c_.groups);
    if (laws.empty()) {
      throw InputError("the baseline has every law that these recordings can have");
    }
    double done = 0;
    const auto before = [&](const std::string& name) {
      options_.check_stop();
      const double share = std::min(1.0, done++ / static_cast<double>(laws.size()));
      options_.report(0.05 + 0.25 * share, name);
    };
    c_.singles = fit_singles(c_.groups, c_.baseline, laws, before, c_.failures);
    if (c_.singles.empty()) {
      throw InputError("experiment " + experiment_.name +
                       ": no law can be evaluated: " + c_.failures.front());
    }
  }

  void pairs() {
    const auto pairs = pairs_of(c_.singles);
    for (const auto& [from, pair] : pairs) {
      options_.check_stop();
      options_.report(
          0.3 + 0.3 * static_cast<double>(c_.pairs.size()) / static_cast<double>(pairs.size()),
          pair.name());
      keep(fit_candidate(c_.groups, c_.baseline, *from, pair), c_.pairs);
    }
    largest_first(c_.pairs, &LawTrial::gain);
    improve_by(c_.pairs, c_.singles);
    add_run_bias(c_.singles), add_run_bias(c_.pairs);
  }

  // Trials of fewer laws by the best of more, if it has all of theirs.
  void improve_by(const std::vector<LawTrial>& more, std::vector<LawTrial>& fewer) {
    if (more.empty()) return;
    const std::vector<const Law*>& laws = more.front().candidate.laws;
    for (LawTrial& trial : fewer) {
      const bool within = std::ranges::all_of(trial.candidate.laws, [&](const Law* one) {
        return std::ranges::find(laws, one) != laws.end();
      });
      if (within) options_.check_stop(), improve(c_.groups, trial, more.front());
    }
    largest_first(fewer, &LawTrial::gain);
  }

  // A bias is identifiable from several runs only.
  void add_run_bias(std::vector<LawTrial>& all) {
    if (experiment_.runs.size() < 4) return;
    for (std::size_t k = 0; k < all.size() && k < 6; ++k) {
      options_.check_stop();
      fit_run_bias(c_.groups, all[k]);
    }
  }

  // The reported pair, and those that are not distinguished from it, with every other law.
  void triples() {
    std::vector<const LawTrial*> pairs = c_.alternatives();
    pairs.resize(std::min(pairs.size(), kStrongest));
    pairs.insert(pairs.begin(), c_.reported);
    for (const LawTrial* pair : pairs) {
      for (const LawTrial& single : c_.singles) {
        Candidate sum = pair->candidate;
        const Law* third = single.candidate.laws[0];
        if (!std::ranges::all_of(sum.laws, [&](auto* one) { return together(*one, *third); })) {
          continue;
        }
        sum.laws.push_back(third);
        if (c_.outcome_of(sum.laws) != nullptr) continue;
        options_.check_stop();
        options_.report(0.99, sum.name());
        keep(fit_candidate(c_.groups, c_.baseline, *pair, sum), c_.triples);
      }
    }
    largest_first(c_.triples, &LawTrial::gain);
    improve_by(c_.triples, c_.pairs);
    add_run_bias(c_.pairs), add_run_bias(c_.triples);
    c_.reported = nullptr;  // the pairs have moved
    c_.select();
    if (c_.reported->candidate.laws.size() == 3) add_pairs_within(*c_.reported);
  }

  // What each of three laws gains is over the other two.
  void add_pairs_within(const LawTrial& triple) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<const Law*> rest = triple.candidate.laws;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
      const LawTrial* from = c_.outcome_of({rest.data(), 1});
      if (c_.outcome_of(rest) != nullptr || from == nullptr) continue;
      keep(fit_candidate(c_.groups, c_.baseline, *from, Candidate{rest}), c_.pairs);
    }
  }

  void nulls() {
    const int number = std::max(9, static_cast<int>(std::lround(4.9 * options_.minutes)));
    KeptRows kept;
    kept.identity = identity_of(experiment_, options_);
    kept.threads = options_.threads, kept.stop = options_.stop;
    if (!options_.out.empty()) {
      kept.file = (std::filesystem::path(options_.out) / "work" / "nulls.rows").string();
    }
    kept.progress = [&](double done, const std::string& note) {
      options_.report(0.6 + 0.39 * done, "simulated baselines, " + note);
    };
    c_.nulls = null_gains(experiment_, c_.groups, c_.baseline, number, options_.seed, kept);
  }

  const BodyExperiment& experiment_;
  const DiagnosisOptions& options_;
  Comparison& c_;
};

}  // namespace
}  // namespace bodies

Diagnosis diagnose_bodies(const BodyExperiment& e, const DiagnosisOptions& options) {
  using namespace bodies;
  const auto lock = claim_directory(options.out, options.force,
                                    {"diagnosis", hex(identity_of(e, options)), diagnosis_files()});
  if (options.lock != nullptr) *options.lock = lock;
  if (std::vector<DiagnosisFinding> faults = recording_faults(e); !faults.empty()) {
    Diagnosis d = described(e);
    d.verdict = Verdict::measurement, d.findings = std::move(faults);
    return d;
  }
  Comparison c;
  c.experiment = &e, c.false_alarms = options.false_alarms;
  c.groups = groups_of(e);
  Trials(e, options, c).run();
  c.rotation = with_free_rotation(c);
  c.far_before = far_errors(c.groups, baseline_at_noise_of(c.groups, c.baseline, *c.reported));
  c.far_after = far_errors(c.groups, *c.reported);
  return diagnosis_of(c);
}

}  // namespace lilytank
