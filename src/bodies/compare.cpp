#include "bodies/compare.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>

#include "lilytank/error.hpp"
#include "lilytank/random.hpp"
#include "statistics/largest_first.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::bodies {

std::string Candidate::name() const {
  return joined(laws, " + ", [](const Law* law) { return std::string(law->name); });
}

bool Candidate::curve() const {
  return std::any_of(laws.begin(), laws.end(), [](const Law* l) { return l->curve; });
}

std::vector<Group> groups_of(const BodyExperiment& e) {
  std::vector<std::string> names;
  std::vector<std::vector<const BodyRun*>> runs;
  for (const BodyRun& run : e.runs) {
    std::string name;
    if (e.coefficients == Coefficients::each_body) name = joined(run.bodies, " and ");
    if (e.coefficients == Coefficients::each_run)
      name = run.part_of.empty() ? run.name : run.part_of;
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

// Share of the noise estimated from second differences: with few samples per motion these are
// motion.
constexpr double kLittleNoise = 0.02;

BodyModel baseline_model(const BodyExperiment& e, Group& g) {
  BodyModel m = first_model(e, g);
  g.penalty_at = packed(m);
  for (const BaselineLaw& one : e.baseline) {
    if (one.law == "contact") {
      m.restitution = one.value;
      continue;
    }
    const Law& law = *find_law(one.law);
    if (law.variable == "turn" && g.typical.dimensions != 2)
      throw InputError(one.place, one.law + " turns velocities, which takes two dimensions");
    std::vector<double> start = law.starts(g.typical).front();
    Term t = term_of(law, g.typical, start, g.runs, m.push);
    if (!one.fit) {
      // A number in the file is the law's amplitude; its other parameters keep their starts.
      t.value = start, t.value[0] = one.value;
      t.fitted.assign(t.value.size(), false);
    }
    m.terms.push_back(std::move(t));
  }
  return m;
}

// Starts of a law's fit. In `base`, pushes and noise may have absorbed the law: one start has small
// pushes, and one little noise where noise is fitted.
std::vector<BodyModel> starts_of(const Group& g, const BodyModel& base, const Law& law) {
  std::vector<BodyModel> out;
  for (const std::vector<double>& start : law.starts(g.typical)) {
    const auto add = [&](BodyModel m, double size) {
      m.terms.push_back(term_of(law, g.typical, start, g.runs, m.push, size));
      out.push_back(std::move(m));
    };
    add(base, 1e-3);
    BodyModel calm = base;
    calm.terms.push_back(term_of(law, g.typical, start, g.runs, base.push, 0.5));
    calm.push = std::max(calm.push * 0.03, calm.least_push);
    out.push_back(std::move(calm));
    if (!base.noise_fitted) continue;
    BodyModel sharp = base;
    sharp.scale_noise(kLittleNoise);
    sharp.push = std::max(base.push, base.usual_push);
    sharp.memory = std::clamp(0.2 * base.most_memory, base.least_memory, base.most_memory);
    add(std::move(sharp), 1e-3);
  }
  return out;
}

// The best of fits from several starts, after a few rounds each; nothing where none gives finite
// predictions.
std::optional<Fitted> best_of(const Group& g, const std::vector<BodyModel>& starts, int rounds) {
  std::optional<Fitted> best;
  for (const BodyModel& start : starts) {
    Fitted f = fit_group(g, start, false, rounds);
    if (f.usable() && (!best || f.likelihood > best->likelihood)) best = std::move(f);
  }
  return best;
}

// The fit with its score on held-out samples, if all predictions are finite.
std::optional<Fitted> scored(const Group& g, Fitted f) {
  leave_folds_out(g, f);
  return f.usable() && std::isfinite(f.held_out_sum()) ? std::optional(std::move(f)) : std::nullopt;
}

std::optional<Fitted> fit_law(const Group& g, const BodyModel& base, const Law& law) {
  constexpr int kFirst = 4;  // steps after which only the best start goes on
  const std::optional<Fitted> best = best_of(g, starts_of(g, base, law), kFirst);
  return best ? scored(g, fit_group(g, best->model)) : std::nullopt;
}

// The baseline from several sizes of pushes and noise: in a local optimum, any law would look
// better.
std::optional<Fitted> fit_from_sizes(const Group& g, const BodyModel& first) {
  std::vector<BodyModel> starts;
  for (const auto& [pushes, memory, noise] : {std::tuple{1.0, 1.0, 1.0},
                                              {0.03, 1.0, 1.0},
                                              {0.1, 0.2, 1.0},
                                              {10.0, 0.2, 1.0},
                                              {1.0, 0.2, kLittleNoise}}) {
    if (noise < 1 && !first.noise_fitted) continue;
    BodyModel& m = starts.emplace_back(first);
    m.push = std::clamp(m.push * pushes, m.least_push, m.most_push);
    m.memory = std::clamp(m.memory * memory, m.least_memory, m.most_memory);
    m.scale_noise(noise);
  }
  std::optional<Fitted> best = best_of(g, starts, 6);
  if (!best) return std::nullopt;
  // Laws' fits start here: an unconverged baseline would add to their gain.
  for (int again = 0; again < 6; ++again) {
    const double before = best->likelihood;
    best = fit_group(g, best->model);
    if (best->likelihood < before + 0.02) break;
  }
  return scored(g, std::move(*best));
}

// All groups, each by `fit`. Where one has no fit, `failure` says why.
LawTrial fit_all(const std::vector<Group>& groups, const std::string& what,
                 const std::function<std::optional<Fitted>(std::size_t)>& fit) {
  LawTrial out;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    std::optional<Fitted> f = fit(i);
    if (!f) {
      out.failure = what + " gives no finite predictions from any start" +
                    (groups[i].name.empty() ? "" : " for " + groups[i].name) + ": samples are " +
                    significant(groups[i].step, 3) + " s apart, which may be too far for it";
      return out;
    }
    out.fits.push_back(std::move(*f));
  }
  gather(out);
  return out;
}

}  // namespace

LawTrial fit_baseline(const BodyExperiment& e, std::vector<Group>& groups) {
  return fit_all(groups, "the baseline", [&](std::size_t i) {
    return fit_from_sizes(groups[i], baseline_model(e, groups[i]));
  });
}

bool absorbs_motion(const BodyModel& baseline, const BodyModel& with) {
  return baseline.noise_fitted && with.squared_noise() < baseline.squared_noise() / 4;
}

LawTrial baseline_at_noise_of(const std::vector<Group>& groups, const LawTrial& baseline,
                              const LawTrial& best) {
  LawTrial out = baseline;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    BodyModel m = baseline.fits[i].model;
    const BodyModel& with = best.fits[i].model;
    if (!absorbs_motion(m, with)) continue;
    m.noise = with.noise, m.noise_y = with.noise_y, m.noise_fitted = false;
    m.push = m.usual_push, m.memory = std::min(10 * groups[i].step, m.most_memory);
    Group g = groups[i];
    g.penalty_at.erase(g.penalty_at.begin(), g.penalty_at.end() - 2);  // the noise's
    if (auto f = fit_from_sizes(g, m)) out.fits[i] = std::move(*f);
  }
  gather(out);
  return out;
}

std::vector<Candidate> single_laws(const BodyExperiment& e, const std::vector<Group>& groups) {
  std::vector<Candidate> out;
  for (const Law& law : law_library()) {
    const bool there = std::any_of(e.baseline.begin(), e.baseline.end(), [&](const BaselineLaw& b) {
      return b.law == law.name || (b.law == "gravity" && b.fit && law.name == "constant_force");
    });
    const bool possible = std::all_of(groups.begin(), groups.end(),
                                      [&](const Group& g) { return law.possible(g.typical); });
    if (!there && possible) out.push_back({{&law}});
  }
  return out;
}

LawTrial fit_candidate(const std::vector<Group>& groups, const LawTrial& baseline,
                       const LawTrial& from, const Candidate& candidate) {
  LawTrial out = fit_all(groups, candidate.name(), [&](std::size_t i) {
    return fit_law(groups[i], from.fits[i].model, *candidate.laws.back());
  });
  out.candidate = candidate;
  if (out.failure.empty()) out.gain = sum(out.by_block) - sum(baseline.by_block);
  return out;
}

bool improve(const std::vector<Group>& groups, LawTrial& trial, const LawTrial& other) {
  constexpr double kBetter = 0.5;  // nat
  bool better = false;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    BodyModel m = trial.fits[i].model;
    const BodyModel& from = other.fits[i].model;
    m.noise = from.noise, m.noise_y = from.noise_y, m.push = from.push, m.memory = from.memory;
    Fitted f = fit_group(groups[i], m);
    if (!f.usable() || f.likelihood < trial.fits[i].likelihood + kBetter) continue;
    if (auto s = scored(groups[i], std::move(f))) trial.fits[i] = std::move(*s), better = true;
  }
  if (better) {
    const double before = sum(trial.by_block);
    gather(trial), trial.gain += sum(trial.by_block) - before;
  }
  return better;
}

namespace {

// By the best outcomes; whether the baseline became better anywhere.
bool improve_baseline(const std::vector<Group>& groups, LawTrial& baseline,
                      const std::vector<LawTrial>& singles) {
  constexpr std::size_t kTried = 3;
  constexpr double kLeastGain = 0.5;  // nat
  bool better = false;
  for (std::size_t k = 0; k < singles.size() && k < kTried; ++k) {
    if (singles[k].gain < kLeastGain) continue;
    better = improve(groups, baseline, singles[k]) || better;
  }
  baseline.gain = 0;
  return better;
}

}  // namespace

std::vector<LawTrial> fit_singles(const std::vector<Group>& groups, LawTrial& baseline,
                                  const std::vector<Candidate>& laws,
                                  const std::function<void(const std::string&)>& before,
                                  std::vector<std::string>& failures) {
  std::vector<LawTrial> out;
  for (int again = 0; again < 2; ++again) {
    out.clear(), failures.clear();
    for (const Candidate& law : laws) {
      if (before) before(law.name());
      LawTrial trial = fit_candidate(groups, baseline, baseline, law);
      if (trial.failure.empty())
        out.push_back(std::move(trial));
      else
        failures.push_back(std::move(trial.failure));
    }
    largest_first(out, &LawTrial::gain);
    if (again > 0 || !improve_baseline(groups, baseline, out)) break;
  }
  return out;
}

namespace {

// The experiment simulated by the fitted baseline, with a bounded number of samples.
BodyExperiment made_up(const BodyExperiment& e, const std::vector<Group>& groups,
                       const LawTrial& baseline, std::uint64_t seed, std::size_t most) {
  BodyExperiment out = e;
  // The filter cannot follow a bounce earlier than predicted. Where the recorded bodies never
  // touch, simulated ones do not collide.
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

std::vector<double> null_gains(const BodyExperiment& e, const std::vector<Group>& groups,
                               const LawTrial& baseline, int number, std::uint64_t seed,
                               const KeptRows& kept) {
  constexpr std::size_t kMost = 1500;  // samples
  const auto rows = kept_rows(kept, number, [&](int r) {
    const BodyExperiment drawn =
        made_up(e, groups, baseline, derived_seed(seed, static_cast<std::uint64_t>(r)), kMost);
    std::vector<Group> own = groups_of(drawn);
    LawTrial base = fit_baseline(drawn, own);
    // Without a fit the gain is 0.
    if (!base.failure.empty()) return std::vector<double>{0};
    std::vector<std::string> failures;
    const auto singles = fit_singles(own, base, single_laws(drawn, own), {}, failures);
    return std::vector<double>{singles.empty() ? 0 : singles.front().gain};
  });
  std::vector<double> out;
  for (const std::vector<double>& row : rows) out.push_back(row.front());
  std::sort(out.begin(), out.end());
  return out;
}

bool Difference::distinguished() const {
  return value > 2 * error && value > 2;
}

Difference difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> blocks(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) blocks[k] = a[k] - b[k];
  Difference out{sum(blocks)};
  if (blocks.size() < 2) return out;
  const auto n = static_cast<double>(blocks.size());
  const double mean = out.value / n;
  double square = 0;
  for (const double p : blocks) square += (p - mean) * (p - mean);
  out.error = std::sqrt(square * n / (n - 1));
  return out;
}

}  // namespace lilytank::bodies
