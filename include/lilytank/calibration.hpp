// The parameters of a model from recordings, with intervals [paper, section 4].
//
// Recordings are simulated again and again (emulator.hpp) until what they tell is like what the
// recordings of the experiment tell. What is compared is chosen by the objective: the paper's MSD
// (Eq. 9), the MSD weighted by its own covariance, or a summary of all motion (motion_summary.hpp).
// A search finds the region, local models (local_model.hpp) the estimate, and experiments simulated
// at the estimate and estimated in their turn the intervals. docs/calibration.md.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lilytank/distributions.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/experiment.hpp"
#include "lilytank/flow_maps.hpp"
#include "lilytank/motion_summary.hpp"
#include "lilytank/report.hpp"
#include "lilytank/search.hpp"

namespace lilytank {

/// A parameter that is looked for.
struct FitParameter {
  std::string path, unit;
  double low = 0, high = 1;  ///< bounds: within them worlds are stable
  bool logarithmic = false;
  bool nuisance = false;  ///< fitted along, not told: the camera's noise
  double to_scale(double value) const;
  double from_scale(double value) const;
};
/// The paper's five of Lilies: K_v, K_F, sigma_stoch, D_linear, D_angular; of balls the drag
/// coefficient in place of K_F, and no D_angular.
std::vector<FitParameter> standard_parameters(BodyKind body);

enum class CalibrationObjective : std::uint8_t {
  summary,       ///< distance of motion summaries by their covariance
  msd_weighted,  ///< distance of MSDs by their covariance
  msd,           ///< Eq. 9
};
CalibrationObjective objective_named(const std::string& word);  ///< throws InputError
std::string name_of(CalibrationObjective objective);

enum class CalibrationFlow : std::uint8_t {
  smooth,  ///< from the experiment's balls, with its errors (the scenario's, where it has no balls)
  paper,   ///< from the balls by Eq. 3
  scenario,  ///< the scenario's own
};
CalibrationFlow flow_named(const std::string& word);  ///< throws InputError
std::string name_of(CalibrationFlow flow);

struct CalibrationOptions {
  BodyKind body = BodyKind::lily;
  CalibrationObjective objective = CalibrationObjective::summary;
  CalibrationFlow flow = CalibrationFlow::smooth;
  std::vector<FitParameter> parameters;  ///< empty: the standard ones
  std::vector<double> start;             ///< of the search; empty: the scenario's values
  int hold_out = 0;                      ///< recordings held out beside those that say so: the last
  /// The search: its name for reports, and how it is made from a space, a start and a seed.
  std::string search_name = "cma-es";
  int search_particles = 0, search_iterations = 0;  ///< of a swarm
  std::int64_t search_budget = 1500;                ///< evaluations, of other searches
  int flow_draws = 24;                              ///< of the flow's error; 0: the flow is exact
  int round = 120, last_round = 240;  ///< simulations of a round, and of the last model
  int most_rounds = 8;
  int replicates = 200;  ///< experiments simulated for the intervals
  int comparisons = 24;  ///< experiments simulated for Eq. 9 before and after
  std::uint64_t seed = 1;
  std::string out;  ///< directory; empty: nothing is kept
  bool force = false;
  int threads = 0;
  const std::atomic<bool>* stop = nullptr;
  /// Called by one thread at a time with the share done of one stage and what it is.
  std::function<void(double done, const std::string& stage)> progress;
};

/// What was found of one parameter.
struct CalibratedParameter {
  FitParameter parameter;
  double start = 0;     ///< the scenario's
  double searched = 0;  ///< the search's answer
  /// What all compared numbers say, without its bias, within the bounds; and, of what they leave
  /// open, the value that makes the MSD most like the recorded one (objective `summary`, flow from
  /// balls).
  double middle = 0, estimate = 0;
  double low = 0, high = 0;  ///< 95 %
  double deviation = 0;      ///< standard error, on the fitted scale
  double bias = 0;           ///< that was taken off, on the fitted scale
  /// The profile: values, and how much the misfit rises when the parameter is held there.
  std::vector<double> profile_value, profile_rise;
};

/// One number of the compared ones: observed, expected at the estimate, and how far apart.
struct ComparedNumber {
  SummaryEntry entry;
  double observed = 0, expected = 0, deviation = 0;
  double z() const { return deviation > 0 ? (observed - expected) / deviation : 0; }
};

/// One local model on the way to the answer.
struct LocalRound {
  std::string name;     ///< "rough model 1": of pieces; "local model 1": of whole experiments
  int simulations = 0;  ///< that it rests on
  double moved = 0;     ///< of its answer from its centre, in deviations of the simulated points
  double misfit = 0;
  bool at_reach = false;         ///< the answer is as far off as it was allowed to be
  std::vector<double> estimate;  ///< of every parameter
};

/// Eq. 9 of a set of recordings, m^2. Every value is the mean over random halves of the recordings'
/// pieces, each against as many pieces: `floor` against the other half, `before` and `after`
/// against simulated ones, `equals` between simulated ones at the estimate. So equal numbers mean
/// equal likeness: a true model is at `equals`, above the floor, as the pieces of one recording are
/// more alike than those of two, and `after` is as large with probability `equals_p`. Where an
/// experiment diverged, `before` or `after` is infinite and the last two are NaN.
struct MsdFit {
  std::string recordings;  ///< "training", "held out"
  int pieces = 0;          ///< in all
  double seconds = 0;      ///< of a piece, and the longest lag
  double before = 0, after = 0, floor = 0, equals = 0, equals_p = 1;
  std::vector<double> lag, real, simulated_before, simulated_after;  ///< s and m^2
};

struct CalibrationResult {
  std::string name, objective, flow, search_name;
  BodyKind body = BodyKind::lily;
  int recordings = 0, bodies = 0;
  double seconds = 0;                           ///< recorded, all recordings together
  double dt = 0;                                ///< s
  std::vector<CalibratedParameter> parameters;  ///< nuisances at the end
  std::vector<double> correlation;              ///< of estimates, [i * parameters + j]
  double misfit = 0, misfit_p = 1;              ///< at the estimate; probability of a larger one
  std::vector<ComparedNumber> numbers;
  std::vector<MsdFit> msd;
  std::vector<std::string> warnings;
  std::vector<IterationRecord> history;  ///< of the search
  std::vector<LocalRound> rounds_taken;
  int rounds = 0, simulations = 0;  ///< of whole experiments
  /// A map of mean velocities of the recordings, and of as many simulated ones [paper, Fig. 7].
  VelocityMap real_velocity, simulated_velocity;
  double tank_radius = 0.3;
  std::string flow_csv;  ///< the extracted flow; empty where the scenario's is used
  /// Of experiments simulated at the estimate and estimated like the data, [replicate][parameter],
  /// without bias, on the fitted scale.
  std::vector<std::vector<double>> replicate_estimates;
};

/// Carries a calibration through, or goes on with one that was stopped in `options.out`. Nothing if
/// it was stopped. Throws InputError if the experiment has no recordings of the body, the directory
/// holds another calibration, or the model diverges wherever it is tried.
std::optional<CalibrationResult> calibrate(const Experiment& experiment,
                                           const CalibrationOptions& options);

struct CalibrationSetup;

/// What the search minimises, for whoever compares searches: the objective's value of one piece of
/// simulation at a point.
class CalibrationSearch {
 public:
  CalibrationSearch(const Experiment& experiment, const CalibrationOptions& options);
  explicit CalibrationSearch(CalibrationSetup setup);
  ~CalibrationSearch();
  CalibrationSearch(CalibrationSearch&&) noexcept;
  const SearchSpace& space() const;
  /// Infinite where the world diverges.
  double value(const Trial& trial) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

/// The report, without its provenance.
ReportDocument calibration_report(const CalibrationResult& calibration);
std::string calibration_text(const CalibrationResult& calibration);
/// Writes calibration.txt (the report), calibration.json, calibrated.toml (an overlay that `run`
/// takes), history.csv, rounds.csv, intervals.csv, correlation.csv, profiles.csv, numbers.csv, and
/// where they are known flow.csv, msd.csv and velocity.csv. Returns the files' names. Throws
/// InputError.
std::vector<std::string> write_calibration(const CalibrationResult& calibration,
                                           const ReportDocument& report, const std::string& dir);
/// Names of all files that write_calibration and draw_calibration may leave in a directory.
std::vector<std::string> calibration_files();

}  // namespace lilytank
