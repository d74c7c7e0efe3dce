// Finding what builds a target best: rule probabilities, a switch of them, pump power and the
// ruleset itself are searched by simulating whole worlds [paper, section 5.2].
//
//   const Optimization what("chain5.toml", {});
//   const OptimizationResult found = run_optimization(what, options);  // out/chain5/optimum.toml
//
// A point of the search is a scenario: a layer over the study's own. A search sees its fitness
// alone, a function of when the copies of the target came to stand, so a world ends as soon as all
// that are possible have. File format, methods and measurements: docs/optimization.md.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lilytank/report.hpp"
#include "lilytank/scenario.hpp"
#include "lilytank/search.hpp"

namespace lilytank {

/// What is made as small as possible. N copies are possible, the k-th first stood at t_k, K came to
/// stand within the horizon T: N and T are the world's own.
enum class Fitness {
  eq10,                    ///< sum of min(t_k - t_(k-1), T), of a missing copy T: s [paper, Eq. 10]
  yield_area,              ///< area between N and the number of copies over time: copies * s
  full_yield_time,         ///< min(t_N, T), whose mean is the restricted mean time to full yield: s
  full_yield_probability,  ///< 0 where K = N, else 1: its mean is the share of runs without
  rate_and_yield,          ///< yield_weight (1 - K / N) - rate_weight K / (time to t_N or T)
};

struct FitnessRule {
  Fitness fitness = Fitness::full_yield_time;
  double rate_weight = 600;  ///< s per copy, of rate_and_yield
  double yield_weight = 1;   ///< of rate_and_yield
};

/// Fitness of one run from the times (s) at which 1, 2, ... copies first stood.
double fitness_of(const FitnessRule& rule, const std::vector<double>& completion, int possible,
                  double horizon);
/// "s", "copies s", "1".
std::string fitness_unit(Fitness fitness);
/// "eq10", ... Throws InputError that names the nearest right word.
Fitness fitness_named(const std::string& word);
std::string name_of(Fitness fitness);
std::vector<std::string> fitness_names();

/// Pump power that is searched along with the parameters.
enum class Agitation {
  none,
  schedule,  ///< constant in pieces of time
  feedback,  ///< by the number of finished copies
};

/// One ruleset of a race.
struct RaceEntry {
  std::string ruleset;           ///< its name
  int round = 1;                 ///< the last that it ran in
  std::int64_t evaluations = 0;  ///< of all its rounds
  double best = 0;               ///< mean fitness of its best point, by that round's search
  double standard_error = 0;
  bool kept = false;  ///< it went on to the next round, or won the last
  /// Mean fitness in the last comparison: of the winner as it was then searched, and of the
  /// scenario's own ruleset at the start.
  std::optional<double> last;
};

/// What a file of an optimisation says.
struct OptimizationPlan {
  std::string name;
  std::vector<std::string> scenarios, sets;  ///< where the scenario came from
  std::uint64_t seed = 1;
  FitnessRule fitness;
  double horizon = 0;         ///< s, run.duration at the start
  int possible = 0;           ///< copies, at the start
  SearchSpace space;          ///< paths of the scenario, "after." of the second set, "power.1" ...
  std::vector<double> start;  ///< where the search begins
  bool hybrid = false;        ///< a second set of probabilities from some number of copies on
  Agitation agitation = Agitation::none;
  int rulesets = 0;         ///< in the race; 0: none is run
  std::int64_t budget = 0;  ///< evaluations in all
  std::string method;       ///< "cma_es", "swarm"
  int replicates = 0;       ///< of the comparison afterwards; 0: none
};

/// A readable optimisation: everything is checked that can be before the first world.
class Optimization {
 public:
  /// Reads the file; `overlays` are laid over its scenarios, `sets` ("path=value") over these.
  /// Throws InputError.
  explicit Optimization(const std::string& file, const std::vector<std::string>& overlays = {},
                        const std::vector<std::string>& sets = {});
  ~Optimization();
  Optimization(Optimization&&) noexcept;
  const OptimizationPlan& plan() const;
  /// The scenario at a point of plan().space, with run.seed = 0.
  Scenario scenario(const std::vector<double>& point) const;
  /// The fitness of one world; +infinity if it diverges; nothing if `stop` was set.
  std::optional<double> evaluate(const Trial& trial, const std::atomic<bool>* stop = nullptr) const;
  /// A new search over plan().space.
  std::unique_ptr<Search> search() const;
  /// A point as an overlay for `lilytank run`, and the rulesets that it names: the first file is
  /// `stem`.toml, the others begin with `stem` as well. `comment`: lines without '#'.
  std::vector<Scenario::Attachment> overlay(const std::vector<double>& point,
                                            const std::string& stem,
                                            const std::string& comment) const;
  /// Equal for optimisations that evaluate the same.
  std::string identity() const;
  struct Source;
  const Source& source() const { return *source_; }

 private:
  std::unique_ptr<const Source> source_;
};

struct OptimizationOptions {
  std::string out;  ///< directory, made if absent
  int threads = 0;  ///< worlds at a time; 0: one a core
  bool force = false;
  const std::atomic<bool>* stop = nullptr;
  /// Called by one thread at a time: share done, and words such as "round 2 of 4, best 3100 s".
  std::function<void(double done, const std::string& note)> progress;
};

struct OptimizationResult {
  bool stopped = false;
  Incumbent best;
  std::vector<IterationRecord> history;  ///< of the (last) search
  bool selected = false;                 ///< the last record is that of its final selection
  std::vector<RaceEntry> race;           ///< by its rulesets' numbers; empty without one
  /// Path of the overlay; "" where best.mean is not finite: worlds of every point diverged.
  std::string optimum;
  std::string compare;  ///< path of the study file that compares; "" if none
  /// Labels of [compare] that it leaves out: their overlays make the optimum's own scenario.
  std::vector<std::string> left_out;
};

/// Searches, or goes on where an earlier call stopped, and writes into the directory: what
/// run_search writes (of a race: in race/<round>/<ruleset>), optimum.toml and its rulesets,
/// race.csv, compare.toml. Throws InputError if it holds another search, or files that would be
/// overwritten, and not `force`, or cannot be written.
OptimizationResult run_optimization(const Optimization& what, const OptimizationOptions& options);

/// The report of a finished optimisation as a document. Provenance is the caller's.
ReportDocument optimization_report(const OptimizationPlan& plan, const OptimizationResult& result);

}  // namespace lilytank
