#include "lilytank/proof.hpp"

#include <algorithm>
#include <cmath>

#include "finder/fitted_model.hpp"
#include "finder/proposal.hpp"
#include "io/sha256.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/random.hpp"
#include "proof/baseline_method.hpp"
#include "proof/closed_loop.hpp"
#include "proof/measured_experiment.hpp"
#include "proof/proof_files.hpp"
#include "proof/proof_tank.hpp"
#include "proof/sealed.hpp"
#include "text/fnv.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr std::uint64_t kKeySeed = 2, kWorldSeed = 3, kFurtherSeed = 1u << 20,
                        kExpectedSeed = 1u << 21, kLoopSeed = 1u << 22;
// A world takes as long as so many simulated experiments, on the average.
constexpr double kOfAWorld = 70;
constexpr int kExpectedRuns = 8;  // experiments by which the expected z is estimated

// The verdicts of the diagnosis and of the simpler methods.
Judged judge_world(PreparedTank& tank, const MeasuredExperiment& measured,
                   const std::vector<Recording>& recordings, Diagnosis& d, ProofWorld& world) {
  if (measured.regression >= 0) {
    const auto effect = static_cast<std::size_t>(measured.regression);
    world.regression = tank.ensemble.plan().effects[effect].name;
  }
  Judged judged = judge(tank, {measured.observed, measured.details}, recordings, d);
  world.verdict = d.verdict;
  world.displacement = tank.ensemble.displacement_misfit(judged.observed.summary);
  for (const DiagnosisFinding& f : d.findings) {
    world.findings.push_back({f.effect, f.alternatives, f.variable, f.z});
  }
  return judged;
}

// A law that no effect has, by the knots of a curve that was found: nothing if that one is of
// something else.
void add_law(const SealedEffect& own, const ForceCurve& found,
             std::map<std::string, double>& truth) {
  const ForceCurve& law = *own.effect.curve;
  for (const std::string& path : own.effect.paths) truth.erase(path);
  if (law.along != found.along || law.toward != found.toward) return;
  const auto value = [&](int knot) {
    const auto k = static_cast<std::size_t>(knot);
    return own.amplitudes[k] * own.effect.sizes[k];
  };
  for (int k = 0; k < kKnots; ++k) {
    const KnotShare at = place_on(law, knot_at(found, k));
    truth[own.effect.paths[static_cast<std::size_t>(k)]] =
        (1 - at.share) * value(at.first) + at.share * value(at.second);
  }
}

// Adds an interval beside the truth, where that is known and there is an interval.
void compare(const std::map<std::string, double>& truth, ProofInterval of, ProofWorld& world) {
  const auto at = truth.find(of.path);
  if (at == truth.end() || !(of.low < of.high)) return;
  of.truth = at->second;
  world.intervals.push_back(std::move(of));
}

void compare_parameters(const Diagnosis& d, const std::map<std::string, double>& truth,
                        ProofWorld& world) {
  for (const MovedParameter& p : d.parameters) {
    compare(truth, {p.path, 0, p.with_effects, p.low, p.high}, world);
  }
}

// The model of an experiment that was diagnosed correctly, against the key and further recordings
// of it.
void model_world(PreparedTank& tank, const Judged& judged, const Model& truth_model,
                 const Sealed& s, double seconds, std::uint64_t seed, Diagnosis& d,
                 ProofWorld& world) {
  const auto further = film_sealed(truth_model, s, seconds, seed);
  if (!further) return;
  fit_findings(tank, judged, *further, d);
  auto truth = truth_of(truth_model, s);
  if (s.kind == "unnamed") {
    const int shape = judged.selected.found.front().shape;
    add_law(s.effects.front(), tank.ensemble.plan().shapes[static_cast<std::size_t>(shape)].curve,
            truth);
  }
  compare_parameters(d, truth, world);
  for (const DiagnosisFinding& f : d.findings) {
    for (const FoundParameter& p : f.parameters)
      compare(truth, {p.path, 0, p.value, p.low, p.high}, world);
  }
  world.removed = d.removed();
  const DiagnosisFinding& first = d.findings.front();
  if (!std::isnan(first.gain)) world.gain = first.gain, world.gain_low = first.gain_low;
}

// Experiments of one seed and number differ by the effects that they are drawn from and by their
// sizes; for names of stages.
std::string drawn_from(const ProofOptions& options) {
  std::string out;
  if (!options.effects.empty()) {
    Fnv hash;
    hash.add(joined(options.effects, " "));
    out = " of " + hex(hash.value());
  }
  return out + (options.sizes == 1 ? "" : " times " + shortest(options.sizes));
}

// Of the weakest of the effects, each alone at its own strength, range and place; of a law that no
// effect has by the curve that shows it best. What the experiment's own parameters change is
// subtracted: the same experiments without the effect.
double expected_z(PreparedTank& tank, const Model& truth_model, const Sealed& s,
                  const std::string& name, std::uint64_t seed) {
  const CalibrationSetup& setup = tank.setup.calibration;
  const auto truth = truth_of(truth_model, s);
  std::vector<double> values = setup.start;
  for (std::size_t k = 0; k < setup.reported_count(); ++k) {
    const auto at = truth.find(setup.paths()[k]);
    if (at != truth.end()) values[k] = at->second;
  }
  const Eigen::VectorXd point = tank.setup.stages.to_scale(values);
  const auto mean = [&](const SealedEffect& of, double times, const std::string& stage) {
    const Eigen::Map<const Eigen::VectorXd> amplitudes(
        of.amplitudes.data(), static_cast<Eigen::Index>(of.amplitudes.size()));
    return tank.ensemble.mean_residual(of.effect, times * amplitudes, point, kExpectedRuns,
                                       "expected " + name + " " + stage, seed);
  };
  if (s.effects.empty()) return 0;
  const Eigen::VectorXd without = mean(s.effects.front(), 0, "without");
  double least = 1e300;
  for (const SealedEffect& own : s.effects) {
    const Eigen::VectorXd net = mean(own, 1, std::to_string(own.like)) - without;
    // A difference of two means is as uncertain as the mean of half as many.
    least = std::min(least, tank.selection.expected_z(own.like, net, kExpectedRuns / 2));
  }
  return least;
}

// One tank and its blinded experiments, diagnosed one after another.
class Examination {
 public:
  explicit Examination(const ProofOptions& options)
      : options_(options),
        tank_(tank_of(options)),
        seed_(derived_seed(options.diagnosis.seed, kKeySeed)),
        seconds_(60 * options.minutes),
        shapes_(shape_catalogue(tank_, seconds_)),
        sealed_(requested(options, tank_, shapes_, seed_)) {
    out_.tank = words_for_tank(options), out_.key = key_of_tank(options);
    for (const Sealed& s : sealed_) out_.key += std::to_string(s.world) + " " + key_text(s);
    out_.hash = sha256(out_.key), out_.sealed = sealed_.size();
  }

  Proof run() {
    const Experiment open = open_tank(options_, tank_);
    const DiagnosisOptions job = diagnosis_options();
    DiagnosisSetup setup(open, job);
    begin_anywhere(setup.calibration);
    const std::string identity = setup.identity() + (job.uncertified ? " uncertified" : "");
    const auto lock = claim_directory(job.out, job.force, {"proof", identity, proof_files()});
    if (job.lock != nullptr) *job.lock = lock;
    if (options_.sealed) options_.sealed(out_.hash);
    find_shortfalls(setup);
    std::optional<PreparedTank> tank;
    if (answered() > 0) {
      tank.emplace(setup, after(setup.model_cost()));
      measure_all(*tank);
    }
    const std::vector<ProofWorld> before = kept_worlds(job.out, out_);
    const double begin = setup.stages.spent();
    for (std::size_t w = 0; w < sealed_.size(); ++w) {
      world_name_ =
          "experiment " + std::to_string(w + 1) + " of " + std::to_string(sealed_.size()) + ": ";
      if (w < before.size() && !asks_for_model(before[w])) {
        out_.worlds.push_back(before[w]);
      } else {
        out_.worlds.push_back(shortfalls_[w].empty() ? ask(*tank, w) : insufficient(w));
        keep(job.out, before);
      }
      const ProofWorld& last = out_.worlds.back();
      modelled_ += last.kind == "null" || last.intervals.empty() ? 0 : 1;
      setup.stages.reach(begin + of_a_world() * static_cast<double>(w + 1) +
                         modelled_ * setup.model_cost());
      if (options_.judged) options_.judged(out_);
    }
    return std::move(out_);
  }

  std::optional<Proof> finished() const {
    const std::string& dir = options_.diagnosis.out;
    if (dir.empty() || !exists(dir + "/key.txt")) return std::nullopt;
    Proof there = read_proof(dir);
    if (there.key != out_.key || there.tank != out_.tank) return std::nullopt;
    return there;
  }

 private:
  // All recordings are fitted; the progress names the experiment.
  DiagnosisOptions diagnosis_options() const {
    DiagnosisOptions job = options_.diagnosis;
    job.hold_out = 0;
    if (job.progress) {
      job.progress = [this, report = job.progress](double done, const std::string& stage) {
        report(done, world_name_ + stage);
      };
    }
    return job;
  }

  // How self-assembly begins shows for minutes, and every experiment begins with other poses than
  // the open recordings: so do the null experiments that serve all of them.
  static void begin_anywhere(CalibrationSetup& setup) {
    for (RecordingShape& shape : setup.shapes) {
      if (shape.latches) shape.starts.clear();
    }
  }

  // Results of this call, then those of earlier ones: an experiment may be diagnosed again for its
  // model.
  void keep(const std::string& dir, const std::vector<ProofWorld>& before) const {
    Proof all = out_;
    for (std::size_t w = all.worlds.size(); w < before.size(); ++w) all.worlds.push_back(before[w]);
    keep_worlds(dir, all);
  }

  double of_a_world() const { return options_.only == "null" ? kOfANull : kOfAWorld; }

  // Simulated experiments that follow the tank's. Those of curves are learned once for all worlds,
  // where something is found.
  double after(double model_cost) const {
    const double worlds = of_a_world() * static_cast<double>(answered());
    if (options_.only == "null") return worlds;
    const int experiments = DiagnosisBudget(options_.diagnosis.minutes).learning.each;
    return worlds + static_cast<double>(shapes_.size()) * kKnots * experiments +
           options_.modelled * model_cost;
  }

  std::uint64_t number(std::size_t w) const { return static_cast<std::uint64_t>(sealed_[w].world); }

  std::optional<std::vector<Recording>> film(std::size_t w) const {
    return film_sealed(tank_, sealed_[w], seconds_, derived_seed(seed_, kWorldSeed + number(w)));
  }

  std::string stage_of(const std::string& name) const {
    return (options_.only.empty() ? name : name + " " + options_.only) + drawn_from(options_);
  }

  // Those that an experiment does not meet are a row. One that diverged has none: it is undecided.
  void find_shortfalls(DiagnosisSetup& setup) {
    shortfalls_.resize(sealed_.size());
    if (setup.options.uncertified) return;
    const CalibrationSetup& known = setup.calibration;
    const auto row = [&](int i) {
      std::vector<double> out;
      const auto made = film(static_cast<std::size_t>(i));
      if (!made) return out;
      const FlowEstimate* flow = known.flow ? &*known.flow : nullptr;
      for (const Shortfall& s : shortfalls_of(flow, known.balls, *made)) {
        out.push_back(static_cast<double>(s.requirement));
      }
      return out;
    };
    const auto rows =
        setup.stages.rows(stage_of("coverage"), static_cast<int>(sealed_.size()), row);
    for (std::size_t w = 0; w < rows.size(); ++w) {
      for (const double r : rows[w]) shortfalls_[w].push_back(static_cast<Requirement>(r));
    }
  }

  std::size_t answered() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(shortfalls_, [](const auto& of) { return of.empty(); }));
  }

  ProofWorld insufficient(std::size_t w) const {
    ProofWorld world;
    world.kind = sealed_[w].kind, world.effects = sealed_[w].names;
    world.verdict = Verdict::insufficient, world.shortfalls = shortfalls_[w];
    return world;
  }

  void measure_all(PreparedTank& tank) {
    const auto row = [&](int i) {
      const auto w = static_cast<std::size_t>(i);
      const auto made = shortfalls_[w].empty() ? film(w) : std::nullopt;
      if (!made) return std::vector<double>{};
      MeasuredExperiment m;
      m.observed = tank.ensemble.vectors(*made, &m.details);
      m.regression = sparse_regression(tank.ensemble.plan(), *made).effect;
      return row_of(m);
    };
    const auto count = static_cast<int>(sealed_.size());
    for (const auto& kept : tank.setup.stages.rows(stage_of("synthetic"), count, row)) {
      measured_.push_back(measured_of(kept));
    }
  }

  static bool found(const ProofWorld& world) {
    return world.right() && world.verdict == Verdict::missing;
  }
  bool asks_for_model(const ProofWorld& world) const {
    return found(world) && world.intervals.empty() && modelled_ < options_.modelled;
  }

  ProofWorld ask(PreparedTank& tank, std::size_t w) const {
    const Sealed& s = sealed_[w];
    ProofWorld world;
    world.kind = s.kind, world.effects = s.names;
    world.expected_z = expected_z(tank, tank_, s, std::to_string(number(w)) + drawn_from(options_),
                                  derived_seed(seed_, kExpectedSeed + number(w)));
    Diagnosis d;
    std::vector<Recording> recordings;
    std::optional<Judged> judged;
    world.verdict = Verdict::undecided;
    if (measured_[w]) {
      recordings = film(w).value_or(recordings);
      judged = judge_world(tank, *measured_[w], recordings, d, world);
      if (options_.closed_loop) world.loop = split_group(tank, *judged, recordings, d, w);
    }
    if (judged && s.kind == "null") {
      report_baseline(tank, *judged, d);
      compare_parameters(d, truth_of(tank_, s), world);
    }
    if (judged && asks_for_model(world)) {
      model_world(tank, *judged, tank_, s, seconds_, derived_seed(seed_, kFurtherSeed + number(w)),
                  d, world);
    }
    return world;
  }

  // Nothing where the strongest finding is no group, or none that the filter predicts.
  std::optional<ProofLoop> split_group(PreparedTank& tank, const Judged& judged,
                                       const std::vector<Recording>& recordings, const Diagnosis& d,
                                       std::size_t w) const {
    if (d.verdict != Verdict::missing) return std::nullopt;
    const OpenQuestion question = open_question(tank.ensemble.plan(), judged, d.verdict);
    if (question.candidates.size() < 2) return std::nullopt;
    const std::uint64_t seed = derived_seed(seed_, kLoopSeed + number(w));
    const auto propose = [&](const std::vector<Recording>& so_far) {
      return proposals(tank, question, so_far);
    };
    const auto further = [&](int modules, double minutes, int which) {
      const auto made = film_sealed(tank_, sealed_[w], modules, 60 * minutes, 1,
                                    derived_seed(seed, static_cast<std::uint64_t>(which)));
      return made.value_or(std::vector<Recording>{});
    };
    return closed_loop(tank.ensemble.plan(), question, recordings, propose, further);
  }

  const ProofOptions& options_;
  Model tank_;
  std::uint64_t seed_;
  double seconds_;
  std::vector<Shape> shapes_;
  std::vector<Sealed> sealed_;
  std::vector<std::vector<Requirement>> shortfalls_;         // of each experiment
  std::vector<std::optional<MeasuredExperiment>> measured_;  // nothing of those that diverged
  Proof out_;
  std::string world_name_;  // before the stage, in the progress
  int modelled_ = 0;
};

}  // namespace

std::optional<Proof> finished_proof(const ProofOptions& options) {
  return Examination(options).finished();
}

Proof prove(const ProofOptions& options) {
  return Examination(options).run();
}

}  // namespace lilytank
