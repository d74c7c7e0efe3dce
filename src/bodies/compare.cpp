#include "bodies/compare.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "lilytank/error.hpp"
#include "lilytank/random.hpp"

namespace lilytank::bodies {

std::string Candidate::name() const {
  std::string out;
  for (const Law* law : laws) out += (out.empty() ? "" : " + ") + std::string(law->name());
  return out;
}

bool Candidate::curve() const {
  return std::any_of(laws.begin(), laws.end(), [](const Law* l) { return l->curve(); });
}

std::vector<Group> groups_of(const BodyExperiment& e) {
  std::vector<std::string> names;
  std::vector<std::vector<const BodyRun*>> runs;
  for (const BodyRun& run : e.runs) {
    std::string name;
    if (e.different) {
      for (const std::string& body : run.bodies) name += (name.empty() ? "" : " and ") + body;
    }
    const auto at =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (at == names.size()) names.push_back(name), runs.emplace_back();
    runs[at].push_back(&run);
  }
  std::vector<Group> out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::all_of(runs[i].begin(), runs[i].end(), [](auto* r) { return r->held_out; })) {
      throw InputError("experiment " + e.name + ": every recording " +
                       (names[i].empty() ? "" : "of " + names[i] + " ") +
                       "is held out: none is left to fit a law to");
    }
    out.push_back(make_group(e, names[i], runs[i]));
  }
  return out;
}

namespace {

void gather(LawTrial& out) {
  out.by_block.clear();
  for (const Fitted& f : out.fits) {
    out.by_block.insert(out.by_block.end(), f.held_out.begin(), f.held_out.end());
  }
}

double sum(const std::vector<double>& v) {
  double out = 0;
  for (const double x : v) out += x;
  return out;
}

BodyModel baseline_model(const BodyExperiment& e, Group& g) {
  BodyModel m = first_model(e, g);
  g.penalty_at = packed(m);
  for (const BaselineLaw& one : e.baseline) {
    if (one.law == "contact") {
      m.restitution = one.value;
      continue;
    }
    const Law& law = *find_law(one.law);
    std::vector<double> start = law.starts(g.typical).front();
    Term t = term_of(law, g.typical, start, g.runs, m.push);
    if (!one.fit) {
      // A number in the file is the law's amplitude; its other numbers are those it starts from.
      t.value = start, t.value[0] = one.value;
      t.fitted.assign(t.value.size(), false);
    }
    m.terms.push_back(std::move(t));
  }
  return m;
}

// Of several starts the one that fits best: also one with small pushes, so that a law need not
// first compete with pushes that have taken its place.
Fitted best_fit(const Group& g, const BodyModel& base, const Law& law) {
  constexpr int kFirst = 4;  // steps after which only the best start goes on
  Fitted best;
  best.likelihood = -1e300;
  for (const std::vector<double>& start : law.starts(g.typical)) {
    for (const auto& [size, pushes] : {std::pair{1e-3, 1.0}, {0.5, 0.03}}) {
      BodyModel m = base;
      m.push = std::max(m.push * pushes, m.least_push);
      m.terms.push_back(term_of(law, g.typical, start, g.runs, base.push, size));
      const Fitted f = fit_group(g, m, false, kFirst);
      if (f.likelihood > best.likelihood) best = f;
    }
  }
  return fit_group(g, best.model);
}

}  // namespace

LawTrial fit_baseline(const BodyExperiment& e, std::vector<Group>& groups) {
  LawTrial out;
  for (Group& g : groups) {
    // From several sizes of pushes: a baseline that is stuck makes any law look good.
    const BodyModel first = baseline_model(e, g);
    Fitted f;
    f.likelihood = -1e300;
    for (const auto& [pushes, memory] :
         {std::pair{1.0, 1.0}, {0.03, 1.0}, {0.1, 0.2}, {10.0, 0.2}}) {
      BodyModel m = first;
      m.push = std::clamp(m.push * pushes, m.least_push, m.most_push);
      m.memory = std::clamp(m.memory * memory, m.least_memory, m.most_memory);
      const Fitted one = fit_group(g, m, false, 6);
      if (one.likelihood > f.likelihood) f = one;
    }
    f = fit_group(g, f.model);
    leave_folds_out(g, f);
    out.fits.push_back(std::move(f));
  }
  gather(out);
  return out;
}

std::vector<Candidate> single_laws(const BodyExperiment& e, const std::vector<Group>& groups) {
  std::vector<Candidate> out;
  for (const Law* law : law_library()) {
    const bool there = std::any_of(e.baseline.begin(), e.baseline.end(), [&](const BaselineLaw& b) {
      return b.law == law->name() ||
             (b.law == "gravity" && b.fit && law->name() == "constant_force");
    });
    const bool possible = std::all_of(groups.begin(), groups.end(),
                                      [&](const Group& g) { return law->possible(g.typical); });
    if (!there && possible) out.push_back({{law}});
  }
  return out;
}

LawTrial fit_candidate(const std::vector<Group>& groups, const LawTrial& baseline,
                       const LawTrial& from, const Candidate& candidate) {
  LawTrial out;
  out.candidate = candidate;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    Fitted f = best_fit(groups[i], from.fits[i].model, *candidate.laws.back());
    leave_folds_out(groups[i], f);
    out.fits.push_back(std::move(f));
  }
  gather(out);
  out.gain = sum(out.by_block) - sum(baseline.by_block);
  return out;
}

namespace {

// The experiment as the fitted baseline makes it up, at most so many samples of it.
BodyExperiment made_up(const BodyExperiment& e, const std::vector<Group>& groups,
                       const LawTrial& baseline, std::uint64_t seed, std::size_t most) {
  BodyExperiment out = e;
  // A filter cannot follow a bounce that comes a little sooner than it thinks. Where the recorded
  // bodies never touch, those that are made up pass each other.
  const bool touch = std::any_of(groups.begin(), groups.end(),
                                 [](const Group& g) { return g.typical.nearest <= 0; });
  if (!touch) std::erase_if(out.baseline, [](const BaselineLaw& l) { return l.law == "contact"; });
  std::size_t all = 0;
  for (const BodyRun& r : e.runs) all += r.samples();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const BodyRun* run : groups[i].runs) {
      const auto at = static_cast<std::size_t>(run - e.runs.data());
      BodyRun& to = out.runs[at];
      if (all > most) {
        const std::size_t n = std::max<std::size_t>(8, to.samples() * most / all);
        const std::size_t row = to.position.size() / to.samples(),
                          d = to.drivers.size() / to.samples();
        if (n < to.samples()) {
          to.time.resize(n), to.position.resize(n * row), to.drivers.resize(n * d);
        }
      }
      BodyModel truth = baseline.fits[i].model;
      if (!touch) truth.restitution = -1;
      to = simulated(truth, groups[i].typical, to, seed, static_cast<std::uint32_t>(at));
    }
  }
  return out;
}

}  // namespace

std::optional<std::vector<double>> null_gains(const BodyExperiment& e,
                                              const std::vector<Group>& groups,
                                              const LawTrial& baseline, int number,
                                              std::uint64_t seed, const KeptRows& kept) {
  constexpr std::size_t kMost = 1500;  // samples
  const auto rows = kept_rows(kept, number, [&](int r) {
    const BodyExperiment drawn =
        made_up(e, groups, baseline, derived_seed(seed, static_cast<std::uint64_t>(r)), kMost);
    std::vector<Group> own = groups_of(drawn);
    const LawTrial base = fit_baseline(drawn, own);
    double best = -1e300;
    for (const Candidate& c : single_laws(drawn, own)) {
      best = std::max(best, fit_candidate(own, base, base, c).gain);
    }
    return std::vector<double>{best};
  });
  if (!rows) return std::nullopt;
  std::vector<double> out;
  for (const std::vector<double>& row : *rows) out.push_back(row.front());
  std::sort(out.begin(), out.end());
  return out;
}

bool Difference::told_apart() const {
  return value > 2 * error && value > 2;
}

namespace {

// Standard error of a sum of `parts`.
double error_of(const std::vector<double>& parts) {
  const auto n = static_cast<double>(parts.size());
  if (parts.size() < 2) return 0;
  const double mean = sum(parts) / n;
  double square = 0;
  for (const double p : parts) square += (p - mean) * (p - mean);
  return std::sqrt(square * n / (n - 1));
}

}  // namespace

Difference difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> blocks(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) blocks[k] = a[k] - b[k];
  return {sum(blocks), error_of(blocks)};
}

}  // namespace lilytank::bodies
