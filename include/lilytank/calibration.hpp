// The parameters of a model from recordings, with intervals [paper, section 4].
//
// The parameters are those at which simulated recordings (emulator.hpp) have the statistics of the
// experiment's recordings. The objective selects the statistics: errors of predictions one frame
// ahead (predictor.hpp), the paper's MSD (Eq. 9), the MSD weighted by its own covariance, or a
// summary of all motion (motion_summary.hpp). A search finds the region (predictions need none),
// response surfaces (response_surface.hpp) the estimate, and experiments simulated at the estimate
// and estimated in their turn the intervals. docs/calibration.md.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lilytank/coverage.hpp"
#include "lilytank/distributions.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/experiment.hpp"
#include "lilytank/fit_parameter.hpp"
#include "lilytank/flow_maps.hpp"
#include "lilytank/job_control.hpp"
#include "lilytank/motion_summary.hpp"
#include "lilytank/report.hpp"
#include "lilytank/search.hpp"

namespace lilytank {

class DirectoryLock;

/// The paper's five of Lilies: K_v, K_F, sigma_stoch, D_linear, D_angular; of balls the drag
/// coefficient in place of K_F, and no D_angular.
std::vector<FitParameter> standard_parameters(BodyKind body);

/// What is compared between recordings and simulations.
enum class CalibrationObjective : std::uint8_t {
  /// Distance of motion summaries by their covariance.
  summary,
  /// Errors of predictions one frame ahead: of the paper's five parameters of Lilies, from
  /// recordings with headings.
  prediction,
  /// Distance of MSDs by their covariance.
  msd_weighted,
  msd,  ///< Eq. 9
};
/// From "summary", "prediction", "msd-weighted" or "msd". Throws InputError on another word.
CalibrationObjective objective_named(const std::string& word);
std::string name_of(CalibrationObjective objective);
/// `prediction` where it can be used, else `summary`.
CalibrationObjective default_objective(const Experiment& experiment, BodyKind body,
                                       const std::vector<FitParameter>& parameters);

/// Where the flow field of the simulations comes from.
enum class CalibrationFlow : std::uint8_t {
  /// From the experiment's balls, with its errors (the scenario's, where it has no balls).
  smooth,
  paper,     ///< from the balls by Eq. 3
  scenario,  ///< the scenario's own
};
/// From "smooth", "paper" or "scenario". Throws InputError on another word.
CalibrationFlow flow_named(const std::string& word);
std::string name_of(CalibrationFlow flow);

/// What a calibration will do, and about how long that takes.
struct CalibrationPlan {
  Coverage coverage;
  int recordings = 0, bodies = 0;  ///< that are fitted; bodies of the largest
  double experiments = 0;          ///< simulated, about
  double experiment_time = 0;      ///< s of processor time, of one
  int extractions = 0;             ///< of the flow from simulated balls
  double extraction_time = 0;      ///< s of processor time, of one
  double processor_time() const {  ///< s
    return experiments * experiment_time + extractions * extraction_time;
  }
};

/// Settings of a calibration. The defaults are those whose coverage docs/calibration.md reports.
struct CalibrationOptions : JobControl {
  BodyKind body = BodyKind::lily;
  CalibrationObjective objective = CalibrationObjective::summary;
  CalibrationFlow flow = CalibrationFlow::smooth;
  /// Empty: standard_parameters(body).
  std::vector<FitParameter> parameters;
  /// Where the search begins, one value per parameter; empty: the scenario's values.
  std::vector<double> start;
  /// Number of recordings, from the last, to hold out beside those that are marked as held out.
  int hold_out = 0;
  /// The search of the region: "cma-es", a swarm's (swarm_presets()) or "none"; empty: "none" where
  /// the objective is `prediction`, else "cma-es".
  std::string search_name;
  /// Of a swarm; 0 for other searches.
  int search_particles = 0, search_iterations = 0;
  /// Budget of other searches, evaluations.
  std::int64_t search_budget = 1500;
  /// Draws of the flow's error that the intervals include; 0: the flow counts as exact.
  /// Negative: 12 for `prediction`, else 24.
  int flow_draws = -1;
  /// Draws of the flow's posterior; combinations of them are flows that could be the true one.
  int posterior_draws = 200;
  int posterior_components = 0;  ///< FlowOptions::components
  /// Simulations of a round, and of the last model. 0: 60 for `prediction`, else 120; twice as
  /// many.
  int round = 0, last_round = 0;
  /// Upper bound on the rounds in which the response surface is moved to its estimate.
  int most_rounds = 8;
  /// Experiments simulated for the intervals. 0: 100 for `prediction`, else 200.
  int replicates = 0;
  /// Experiments simulated for Eq. 9 before and after.
  int comparisons = 24;
  /// Key of every random number of the calibration.
  std::uint64_t seed = 1;
  /// Directory; empty: nothing is kept.
  std::string out;
  /// Replace the files of another calibration in `out`.
  bool force = false;
  /// Receives the lock of the directory, for a caller who writes more there; null: the lock ends
  /// with the call.
  std::shared_ptr<const DirectoryLock>* lock = nullptr;
  /// Simulations at a time; 0: one per core. The result does not depend on it.
  int threads = 0;
  /// Receives what the recordings cover, before anything is simulated.
  std::function<void(const Coverage& coverage)> covered;
  /// If set, one extraction and one experiment are simulated to time them, and this receives the
  /// plan.
  std::function<void(const CalibrationPlan& plan)> planned;
};

/// What was found of one parameter.
struct CalibratedParameter {
  FitParameter parameter;
  /// The scenario's value.
  double start = 0;
  /// The value in the simulation that made the recordings; NaN: not known.
  double truth = NAN;
  /// The search's estimate.
  double searched = 0;
  /// middle: bias-corrected estimate from all statistics, within the bounds. estimate: the value in
  /// the posterior of `middle` with the least difference of the MSD (objective `summary`, flow from
  /// balls); otherwise `middle`.
  double middle = 0, estimate = 0;
  /// 95 % interval, bias-corrected.
  double low = 0, high = 0;
  /// Standard error, on the fitted scale.
  double deviation = 0;
  /// Bias that the estimate was corrected for, on the fitted scale.
  double bias = 0;
  /// The profile: values, and how much the misfit rises when the parameter is held there.
  std::vector<double> profile_value, profile_rise;
};

/// One number of the compared ones: observed, expected at the estimate, and how far apart.
struct ComparedNumber {
  SummaryEntry entry;
  /// In the statistic's own unit; `deviation` is the standard deviation in one experiment.
  double observed = 0, expected = 0, deviation = 0;
  /// Standardised residual.
  double z() const { return deviation > 0 ? (observed - expected) / deviation : 0; }
};

/// One response surface on the way to the estimate.
struct LocalRound {
  /// "rough model 1": of pieces; "local model 1": of whole experiments.
  std::string name;
  /// Simulations that it is fitted to.
  int simulations = 0;
  /// Distance of its estimate from the centre of the simulated points, in their standard
  /// deviations.
  double moved = 0;
  /// Value of the objective at that estimate.
  double misfit = 0;
  /// The estimate lies on the bound of the fit: the next round is centred there.
  bool at_bound = false;
  /// One value per parameter.
  std::vector<double> estimate;
};

/// Eq. 9 of a set of recordings, m^2. Every value is the mean over random halves of the recordings'
/// pieces, each against as many pieces: `floor` against the other half, `before` and `after`
/// against simulated ones, `equals` between simulated ones at the estimate. So equal numbers mean
/// equal likeness: a true model is at `equals`, above the floor, as the pieces of one recording are
/// more alike than those of two, and `after` is as large with probability `equals_p`. Where an
/// experiment diverged, `before` or `after` is infinite and the last two are NaN.
struct MsdFit {
  /// Which recordings: "training" or "held out".
  std::string recordings;
  /// Pieces of all these recordings, and simulated experiments that each set of values has.
  int pieces = 0, experiments = 0;
  /// Length of a piece, and the longest lag, s.
  double seconds = 0;
  double before = 0, after = 0, floor = 0, equals = 0, equals_p = 1;
  /// Mean MSD (m^2) over lag (s): recorded, simulated with the scenario's values and with the
  /// estimates.
  std::vector<double> lag, real, simulated_before, simulated_after;
  /// 95 % bands of these MSDs, m^2: of the mean over recorded pieces, and of a simulated
  /// experiment. Empty: fewer than two of them.
  std::vector<double> real_low, real_high, after_low, after_high;
  /// Mean |difference| of MSDs of halves at each lag, m^2: between recorded halves (noise floor),
  /// and of recorded from simulated ones. Empty if an experiment diverged.
  std::vector<double> floor_at, before_at, after_at;
};

/// The estimate, its uncertainty and what supports it.
struct CalibrationResult {
  std::string name, objective, flow, search_name;
  /// Of the flow map, where the bodies are Lilies.
  Coverage coverage;
  BodyKind body = BodyKind::lily;
  /// Recordings that were fitted, and bodies in them.
  int recordings = 0, bodies = 0;
  /// Recorded time of all recordings, s.
  double seconds = 0;
  /// Time step of the simulations, s.
  double dt = 0;
  /// In the order of the options, nuisance parameters last.
  std::vector<CalibratedParameter> parameters;
  /// Correlation of the estimates i and j, [i * parameters + j].
  std::vector<double> correlation;
  /// Misfit at the estimate, and the probability of a larger one under the model.
  double misfit = 0, misfit_p = 1;
  /// Every compared statistic, in the order of its summary.
  std::vector<ComparedNumber> numbers;
  std::vector<MsdFit> msd;
  std::vector<std::string> warnings;
  /// Of the global search.
  std::vector<IterationRecord> history;
  std::vector<LocalRound> rounds_taken;
  /// Rounds of response surfaces, and simulations of whole experiments in them.
  int rounds = 0, simulations = 0;
  /// A map of mean velocities of the recordings, and of as many simulated ones [paper, Fig. 7].
  VelocityMap real_velocity, simulated_velocity;
  double tank_radius = 0.3;
  /// The extracted flow; empty where the scenario's is used.
  std::string flow_csv;
  /// The experiment's values that the estimates hold for: scenario paths and SI values.
  std::vector<std::pair<std::string, double>> conditions;
  /// [replicate][parameter] Estimates from experiments that were simulated at the estimate,
  /// bias-corrected, on the fitted scale.
  std::vector<std::vector<double>> replicate_estimates;
};

/// Carries a calibration through, or goes on with one that was stopped in `options.out`. Throws
/// Stopped, and InputError if the experiment has no recordings of the body, the directory
/// holds another calibration, or the model diverges wherever it is tried.
CalibrationResult calibrate(const Experiment& experiment, const CalibrationOptions& options);
/// What calibrate() would do. Writes nothing; takes one extraction of the flow and one simulated
/// experiment.
CalibrationPlan plan_calibration(const Experiment& experiment, const CalibrationOptions& options);

struct CalibrationSetup;

/// What the search minimises, for whoever compares searches: the objective's value of one piece of
/// simulation at a point.
class CalibrationSearch {
 public:
  /// Prepares the experiment as calibrate() does. Throws InputError like it.
  CalibrationSearch(const Experiment& experiment, const CalibrationOptions& options);
  explicit CalibrationSearch(CalibrationSetup setup);
  ~CalibrationSearch();
  CalibrationSearch(CalibrationSearch&&) noexcept;
  /// One axis per parameter, on its bounds.
  const SearchSpace& space() const;
  /// Infinite where the world diverges.
  double value(const Trial& trial) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

/// The report, without its provenance.
ReportDocument calibration_report(const CalibrationResult& calibration);
/// Writes calibration.txt (the report), calibration.json, calibrated.toml (an overlay that `run`
/// takes), history.csv, rounds.csv, intervals.csv, correlation.csv, profiles.csv, numbers.csv, and
/// where they are known flow.csv, msd.csv and velocity.csv. Returns the files' names. Throws
/// InputError.
std::vector<std::string> write_calibration(const CalibrationResult& calibration,
                                           const ReportDocument& report, const std::string& dir);
/// Names of all files that write_calibration and draw_calibration may leave in a directory.
std::vector<std::string> calibration_files();

}  // namespace lilytank
