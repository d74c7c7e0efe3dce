// Searching a box for the point with the lowest value, where every evaluation is costly and noisy.
//
// A search is asked for points and told their values; it never knows how they are evaluated:
//
//   auto search = make_swarm(space, options, seed);
//   for (auto trials = search->ask(); !trials.empty(); trials = search->ask()) {
//     search->tell(values_of(trials));  // in any order, on any number of threads
//   }
//   const Incumbent found = search->best();
//
// Everything it does is a function of space, options, seed and the values told, and save() holds
// all of it, so a search goes on to the same bits after any interruption. run_search
// (search_run.hpp) does just that in a directory. Algorithms, sources and measurements:
// docs/search.md.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lilytank {

/// One searched parameter, in its own unit. Points never leave [low, high].
struct SearchAxis {
  /// Letters, digits, '_', '.' and '-'; no two alike.
  std::string name;
  double low = 0, high = 1;  ///< low < high
  /// Searched on a log scale; then low > 0.
  bool logarithmic = false;
};
/// The box that is searched.
using SearchSpace = std::vector<SearchAxis>;

/// One requested evaluation.
struct Trial {
  /// One value an axis, in its unit.
  std::vector<double> point;
  /// Tells repeated evaluations of a point apart; the caller makes a seed of it. Under common
  /// random numbers the k-th evaluation of every point has replicate k (from 0), and a final
  /// selection goes on with the first one that no candidate had; otherwise every trial of a search
  /// has its own.
  std::int64_t replicate = 0;
};

/// The best point so far.
struct Incumbent {
  /// Empty before the first iteration is over.
  std::vector<double> point;
  /// Mean of its values; +infinity if one of them was not finite.
  double mean = 0;
  /// Standard error of the mean, from its own values; NaN with fewer than two.
  double standard_error = 0;
  int evaluations = 0;  ///< how many values
};

/// How an iteration ended: one row of history.csv and one point of a convergence plot (Fig. 6a).
struct IterationRecord {
  int iteration = 0;             ///< from 1
  std::int64_t evaluations = 0;  ///< received so far
  double best = 0;               ///< the incumbent's mean
  /// Of the means of this iteration's new points.
  double median = 0, worst = 0;
  std::vector<double> best_point;  ///< the incumbent
  /// Of the swarm: root mean square distance of the particles from their centre. Of CMA-ES: sigma
  /// times the root of the mean eigenvalue. Both as a share of the axes' (log) ranges.
  double spread = 0;
};

/// See the top of this file. Not shared between threads.
class Search {
 public:
  virtual ~Search() = default;
  /// What to evaluate next; empty once the budget is spent. Asking again before telling gives the
  /// same trials again.
  virtual std::vector<Trial> ask() = 0;
  /// The values of the trials of ask(), in their order; lower is better. A value that is not finite
  /// is worse than every number. Throws std::logic_error on another count of values.
  virtual void tell(std::span<const double> values) = 0;
  /// The best point so far.
  virtual Incumbent best() const = 0;
  /// One record for each iteration that is over.
  virtual const std::vector<IterationRecord>& history() const = 0;
  /// Whether a final selection is over: the last record is then its own, and no iteration's.
  virtual bool selected() const = 0;
  /// Trials evaluated so far, and in all. A budget that does not divide into whole iterations may
  /// not be spent completely.
  virtual std::int64_t evaluations() const = 0;
  virtual std::int64_t budget() const = 0;
  /// The box, as given.
  virtual const SearchSpace& space() const = 0;
  /// The whole state as text, with a magic word, a version and a hash; space, options, seed and
  /// trials that were requested and not yet evaluated included.
  virtual std::string save() const = 0;
  /// The share of the budget that is spent, 0 .. 1.
  double done() const;
};

/// Whose best positions a particle looks at, its own always included.
enum class Neighbourhood {
  global,  ///< all
  ring,    ///< one on each side
  /// Four, on a lattice of about as many rows as columns, wound as a helix.
  von_neumann,
};

/// What is done about noise, with the same budget under every rule.
enum class NoiseRule {
  /// Each new position gets all evaluations of its particle; a personal best keeps its mean.
  none,
  /// Half of the evaluations (rounded down) go to the personal best, whose values are aggregated
  /// [Pugh, Zhang and Martinoli 2005]. Needs two evaluations.
  reevaluate,
  /// New positions get one evaluation, the rest of an iteration's budget goes, in stages, to those
  /// new positions and personal bests that best separate the best point from the rest: optimal
  /// computing budget allocation [Chen et al. 2000; Pan, Wang and Liu 2006]. Needs two evaluations.
  ocba,
};

/// What happens to a particle that would leave the box; its position is put on the bound.
enum class AtBound {
  /// The velocity along that axis becomes 0.
  stop,
  /// It turns round, and the position is mirrored at the bound.
  reflect,
  /// It stays as it is (the authors of the paper).
  keep,
};

/// Particle swarm optimisation, Eqs. 6a and 6b of the paper, each particle at once with the others
/// and random numbers for each axis. Defaults: Pedersen's parameters for 5 dimensions and 1000
/// evaluations [Good parameters for particle swarm optimization, HL1001, 2010]. With their negative
/// inertia an unlimited swarm grows without bound: hence limit and bounds.
struct SwarmOptions {
  int particles = 47, iterations = 100;  ///< at least 2 and 1
  double inertia = -0.1832;              ///< w
  double personal = 0.5287;              ///< w_p
  double neighbour = 3.1913;             ///< w_n
  Neighbourhood neighbourhood = Neighbourhood::global;
  /// Bound on |v| per iteration, as a fraction of an axis' (log) range.
  double velocity_limit = 0.3;
  AtBound at_bound = AtBound::stop;
  /// Evaluations per particle and iteration: the budget is particles * iterations * evaluations +
  /// final_evaluations.
  int evaluations = 2;
  NoiseRule noise = NoiseRule::ocba;
  /// Stages of an iteration after the new positions' first evaluations.
  int ocba_stages = 4;
  /// After the last iteration so many more are shared out by OCBA among the leading personal bests,
  /// whose earlier values do not count any more: a point leads a search by luck, too. 0, or at
  /// least 4.
  int final_evaluations = 0;
  /// The k-th evaluation of every point shares its random numbers (Trial::replicate).
  bool common_random_numbers = false;
  /// Where the first particles start, as far as given; the others start uniformly at random.
  std::vector<std::vector<double>> starts;
};

/// Covariance matrix adaptation, (mu/mu_w, lambda) with active update [Hansen, The CMA evolution
/// strategy: a tutorial, 2016], in the unit box of the axes' (log) ranges. Samples beyond its sides
/// are put on them, and so is the mean: lowest points on a bound are found exactly. Where the
/// distribution has become too small to matter, it starts anew at a random place with twice the
/// population [Auger and Hansen 2005] for as long as the budget lasts.
struct CmaEsOptions {
  std::int64_t budget = 1000;  ///< trials in all
  /// lambda; 0: 4 + floor(3 ln n) for n axes.
  int population = 0;
  /// Standard deviation of the first samples, as a fraction of the ranges.
  double sigma = 0.3;
  /// The first mean; empty: the middle of the box.
  std::vector<double> start;
  int evaluations = 1;  ///< of each sample, at first
  /// Measures by further evaluations how much noise changes the samples' ranks and adapts the
  /// number of evaluations of each, up to `most_evaluations`; beyond that it widens the
  /// distribution [Hansen, Niederberger, Guzzella and Koumoutsakos 2009].
  bool handle_uncertainty = true;
  /// Upper bound on evaluations per sample.
  int most_evaluations = 16;
  /// Of the budget, kept for the end and shared out by OCBA among the leading samples, the final
  /// mean and the start, if one is given, by new values only. 0, or at least 4.
  int final_evaluations = 100;
  bool common_random_numbers = false;
};

/// The best settings of docs/search.md's measurements for this many evaluations, of which a tenth
/// go to the final selection: use these, and CMA-ES before the swarm, unless there is a reason.
SwarmOptions swarm_for(std::int64_t budget, int particles);
/// The same for CMA-ES.
CmaEsOptions cma_es_for(std::int64_t budget);

/// Throw InputError on a space or options that make no sense.
std::unique_ptr<Search> make_swarm(SearchSpace space, SwarmOptions options, std::uint64_t seed);
std::unique_ptr<Search> make_cma_es(SearchSpace space, CmaEsOptions options, std::uint64_t seed);
/// The search that save() was called on. Throws InputError, with `file` and the line, if the bytes
/// are damaged or of another version.
std::unique_ptr<Search> restore_search(std::string_view bytes, const std::string& file);

/// The paper's swarms: "paper-balls" and "paper-lilies" (Table 1: 47 particles, 30 and 100
/// iterations, personal bests re-evaluated, section 4.1) and "paper-rulesets" (section 5.2: 15
/// particles, 20 iterations, each position evaluated twice). Throws InputError on another name.
SwarmOptions swarm_preset(const std::string& name);
/// The names that swarm_preset knows.
std::vector<std::string> swarm_presets();

/// "global", "ring", "von-neumann"; "none", "reevaluate", "ocba". Throw InputError on other words.
Neighbourhood neighbourhood_named(const std::string& word);
NoiseRule noise_rule_named(const std::string& word);
std::string name_of(Neighbourhood neighbourhood);
std::string name_of(NoiseRule rule);

/// The particles that particle i of `particles` looks at, itself included, in rising order.
std::vector<int> neighbours_of(Neighbourhood neighbourhood, int particles, int i);

/// What is known of one of several candidates.
struct OcbaCandidate {
  /// Not finite: known to be no candidate.
  double mean = 0;
  /// Standard deviation of one evaluation.
  double deviation = 0;
  int evaluations = 0;  ///< that it had
};
/// The evaluations each candidate should have had in all once `extra` more are spent, by Chen's
/// rule [Chen, Lin, Yuecesan and Chick 2000, Eqs. 4 and 5]: N_i / N_j = ((s_i / d_i) / (s_j /
/// d_j))^2 for i, j other than the best b, d the difference of the means from the best one, and N_b
/// = s_b sqrt(sum N_i^2 / s_i^2). Real numbers that sum to all evaluations, old and new.
std::vector<double> ocba_targets(std::span<const OcbaCandidate> candidates, int extra);
/// `extra` evaluations shared out among the candidates that are short of their targets, in whole
/// numbers that sum to `extra`.
std::vector<int> ocba_shares(std::span<const OcbaCandidate> candidates, int extra);

}  // namespace lilytank
