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
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lilytank/job_control.hpp"
#include "lilytank/report.hpp"
#include "lilytank/scenario.hpp"
#include "lilytank/search.hpp"

namespace lilytank {

class DirectoryLock;

/// What is made as small as possible. N copies are possible, the k-th first stood at t_k, K came to
/// stand within the horizon T: N and T are the world's own.
enum class Fitness {
  /// Sum of min(t_k - t_(k-1), T), of a missing copy T: s [paper, Eq. 10].
  eq10,
  /// Area between N and the number of copies over time: copies * s.
  yield_area,
  /// min(t_N, T), whose mean is the restricted mean time to full yield: s.
  full_yield_time,
  /// 0 where K = N, else 1: its mean is the share of runs without.
  full_yield_probability,
  /// yield_weight (1 - K / N) - rate_weight K / (time to t_N or T).
  rate_and_yield,
};

/// A fitness with its weights.
struct FitnessRule {
  /// What is minimised.
  Fitness fitness = Fitness::full_yield_time;
  /// Weight of the rate, s per copy, of rate_and_yield.
  double rate_weight = 600;
  /// Weight of the missing fraction, of rate_and_yield.
  double yield_weight = 1;
};

/// Fitness of one run from the times (s) at which 1, 2, ... copies first stood.
double fitness_of(const FitnessRule& rule, const std::vector<double>& completion, int possible,
                  double horizon);
/// Unit of a fitness: "s", "copies s" or "1".
std::string fitness_unit(Fitness fitness);
/// "eq10", "yield_area", ...
std::string name_of(Fitness fitness);
/// All names, in the order of the enumeration.
std::vector<std::string> fitness_names();

/// Pump power that is searched along with the parameters.
enum class Agitation {
  none,
  schedule,  ///< constant in pieces of time
  /// By the number of finished copies.
  feedback,
};

/// One ruleset of a race.
struct RaceEntry {
  /// Name of the ruleset.
  std::string ruleset;
  /// The last round in which it ran.
  int round = 1;
  /// Evaluations of all its rounds.
  std::int64_t evaluations = 0;
  /// Mean fitness of its best point, by that round's search.
  double best = 0;
  /// Standard error of `best`, from the values of that point.
  double standard_error = 0;
  /// It went on to the next round, or won the last.
  bool kept = false;
  /// Mean fitness in the last comparison: of the winner as it was then searched, and of the
  /// scenario's own ruleset at the start.
  std::optional<double> last;
};

/// What a file of an optimisation says.
struct OptimizationPlan {
  /// From the file.
  std::string name;
  /// Files and --set values of the scenario, as documentation.
  std::vector<std::string> scenarios, sets;
  /// Key of the search and of the simulations.
  std::uint64_t seed = 1;
  FitnessRule fitness;
  /// run.duration at the start, s.
  double horizon = 0;
  /// Copies that the modules can form at the start.
  int possible = 0;
  /// Paths of the scenario, "after." of the second set, "power.1" ...
  SearchSpace space;
  /// Where the search begins; one value per axis.
  std::vector<double> start;
  /// Whether a second set of probabilities takes effect from some number of copies on.
  bool hybrid = false;
  Agitation agitation = Agitation::none;
  /// Rulesets in the race; 0: no race.
  int rulesets = 0;
  /// Evaluations in all.
  std::int64_t budget = 0;
  /// "cma_es" or "swarm".
  std::string method;
  /// Runs per setting of the comparison afterwards; 0: none.
  int replicates = 0;
};

/// A readable optimisation: everything is checked that can be before the first world.
class Optimization {
 public:
  /// Reads the file; `overlays` are laid over its scenarios, `sets` ("path=value") over these;
  /// run.seed is the seed of the search. Throws InputError.
  explicit Optimization(const std::string& file, const std::vector<std::string>& overlays = {},
                        std::vector<std::string> sets = {});
  ~Optimization();
  Optimization(Optimization&&) noexcept;
  /// What the file says, resolved.
  const OptimizationPlan& plan() const;
  /// The scenario at a point of plan().space, with run.seed = 0.
  Scenario scenario(const std::vector<double>& point) const;
  /// The fitness of one world; +infinity if it diverges. Throws Stopped.
  double evaluate(const Trial& trial, const JobControl& control = {}) const;
  /// A new search over plan().space.
  std::unique_ptr<Search> search() const;
  /// A point as an overlay for `lilytank run`, and the rulesets that it names: the first file is
  /// `stem`.toml, the others begin with `stem` as well. `comment`: lines without '#'.
  std::vector<Scenario::Attachment> overlay(const std::vector<double>& point,
                                            const std::string& stem,
                                            const std::string& comment) const;
  /// Equal for optimisations that evaluate the same.
  std::string identity() const;
  /// Internal to src/optimize.
  struct Source;
  const Source& source() const { return *source_; }

 private:
  std::unique_ptr<const Source> source_;
};

/// Where the optimisation is kept, and how it runs.
struct OptimizationOptions : JobControl {
  std::string out;  ///< directory, made if absent
  /// Simulations at a time; 0: one per core.
  int threads = 0;
  /// Replace the files of another optimisation in `out`.
  bool force = false;
  /// Receives the lock of the directory, for a caller who writes more there; null: the lock ends
  /// with the call.
  std::shared_ptr<const DirectoryLock>* lock = nullptr;
};

/// What was found, and how the search got there.
struct OptimizationResult {
  /// The answer; its mean is of the final selection where there was one.
  Incumbent best;
  std::vector<IterationRecord> history;  ///< of the (last) search
  /// The last record is that of its final selection.
  bool selected = false;
  /// By its rulesets' numbers; empty without one.
  std::vector<RaceEntry> race;
  /// Path of the overlay; "" where best.mean is not finite: worlds of every point diverged.
  std::string optimum;
  /// Path of the study file that compares start and optimum; "" if there is none.
  std::string compare;
  /// Labels of [compare] that it leaves out: their overlays make the optimum's own scenario.
  std::vector<std::string> left_out;
};

/// Searches, or goes on where an earlier call stopped, and writes into the directory: what
/// run_search writes (of a race: in race/<round>/<ruleset>), optimum.toml and its rulesets,
/// race.csv, compare.toml. Throws Stopped, and InputError if it holds another search, or files that
/// would be overwritten, and not `force`, or cannot be written.
OptimizationResult run_optimization(const Optimization& what, const OptimizationOptions& options);

/// The report of a finished optimisation as a document. Provenance is the caller's.
ReportDocument optimization_report(const OptimizationPlan& plan, const OptimizationResult& result);

}  // namespace lilytank
