// What physics a model leaves out: where simulation and recordings differ, which effect it is, the
// effect's size, and how much of the difference it removes. docs/diagnosis.md.
#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lilytank/coverage.hpp"
#include "lilytank/diagnosis_subject.hpp"
#include "lilytank/experiment.hpp"
#include "lilytank/job_control.hpp"
#include "lilytank/next_experiment.hpp"
#include "lilytank/report.hpp"

namespace lilytank {

class DirectoryLock;

/// A smaller budget has as many simulations as this one, of recordings in a tank: 160 null
/// experiments, the fewest that thresholds can rest on. In one tank they gave 8 false positives in
/// 100 null experiments, the 240 of the default 2 (docs/validation.md).
inline constexpr double kLeastTankMinutes = 3;

struct DiagnosisOptions : JobControl {
  int hold_out = 1;     ///< recordings held out where no file sets held_out: the last ones
  double minutes = 10;  ///< time budget on two cores: scales the simulations
  /// Go on with recordings that do not meet the requirements (coverage.hpp); error rates are then
  /// unknown.
  bool uncertified = false;
  /// False-positive rate: share of null experiments reported as missing.
  double false_alarms = 0.02;
  std::uint64_t seed = 1;
  std::string out;     ///< directory; empty: nothing is stored
  bool force = false;  ///< replace another diagnosis's files
  /// Receives the lock of the directory, for a caller who writes more there; null: the lock ends
  /// with the call.
  std::shared_ptr<const DirectoryLock>* lock = nullptr;
  int threads = 0;
};

enum class Verdict : std::uint8_t {
  complete,      ///< no omitted effect that these data can show
  missing,       ///< an omitted effect; see findings
  measurement,   ///< the recordings are faulty; no force is searched for
  undecided,     ///< the model differs; these data cannot identify how
  insufficient,  ///< recordings too short, or a flow map too poor, for error rates that are known
};
std::string name_of(Verdict verdict);

/// A number of an effect with its 95 % interval.
struct FoundParameter {
  std::string name, path;
  double value = 0, low = 0, high = 0;
  std::string unit;
};

/// Values of a curve: an empirical force law, or a map of residuals.
struct FoundCurve {
  std::string variable, direction, unit, value_unit;
  std::vector<double> at, value, deviation;  ///< deviation: under the null hypothesis
  double z = 0;                              ///< of the curve as a whole
};

/// Estimates of an effect that has a place, each as if it were alone: a map of the mismatch over
/// the tank.
struct PlaceMap {
  struct Place {
    double x = 0, y = 0;        ///< m
    std::vector<double> value;  ///< a component
    double z = 0;
  };
  std::vector<std::string> components, units;  ///< of the amplitudes
  double width = 0, tank_radius = 0;           ///< m; width: of the effect at each place
  std::vector<Place> places;                   ///< of a hexagonal grid, row by row
};

struct DiagnosisFinding {
  std::string effect;  ///< of the catalogue, or "unnamed"
  std::vector<std::string> alternatives;
  /// 1 - probability that with nothing there the strongest of all that is tried is as strong.
  double confidence = 0;
  double z = 0;
  std::string variable;         ///< position, radius, pair, slip, heading, spin, time, module, lag
  double from = 0, to = 0;      ///< where it acts
  std::string unit, text;       ///< of the variable; in words
  std::string equation, split;  ///< the experiment that would split a group; "" if there is none
  std::vector<FoundParameter> parameters;
  FoundCurve curve;  ///< the region's map; of unnamed effects their law
  PlaceMap places;   ///< of an effect that has a place; else empty
  /// nat on held-out recordings, one step ahead; NaN of faults of the control, which move nothing.
  double gain = 0, gain_low = 0, gain_high = 0;
};

/// The smallest size of an effect that would have been seen in half of all cases, along the axis
/// and at the range that show least; infinite: none up to the largest that was tried.
struct Detectable {
  std::string effect, path;
  double smallest = 0, tried = 0;
  std::string unit;
  std::string parameter() const;  ///< the path's last word
};

/// An effect alone. Of those that are tried at several ranges or times each is one.
struct RankedEffect {
  std::string effect, variant;  ///< "pair_attraction", "strength, range = 0.012 m"
  double z = 0;
};

/// How far a group of numbers is off, in mean squares of its deviations, before and after.
struct GroupFit {
  std::string group;
  double before = 0, after = 0;
  /// Mean and deviation of what chance alone gives, by experiments with what was found; deviation
  /// 0: not known.
  double chance = 1, deviation = 0;
  bool clear() const;      ///< there was more to remove than three deviations of chance
  double removed() const;  ///< share of what is beyond chance
};

/// One of the five before and after the effects were added; where nothing is missing, after is by
/// the line through experiments of known parameters.
struct MovedParameter {
  std::string path, unit;
  double baseline = 0, deviation = 0, with_effects = 0;
  double low = NAN, high = NAN;  ///< 95 %; NaN: not known, as something is there without a model
};

struct Diagnosis {
  std::string name;
  Verdict verdict = Verdict::undecided;
  std::vector<DiagnosisFinding> findings;
  std::vector<Detectable> detectable;
  std::vector<MovedParameter> parameters;
  std::vector<GroupFit> held_out;
  double msd_before = 0, msd_after = 0, msd_floor = 0;  ///< m^2, Eq. 9 of held-out recordings
  double msd_removed = 0, msd_low = 0, msd_high = 0;
  std::vector<FoundCurve> maps;       ///< every shape's curve of the baseline's residuals
  std::vector<RankedEffect> ranking;  ///< strongest first
  double effect_threshold = 0, shape_threshold = 0, false_alarms = 0;
  double strongest_left = 0;  ///< z of the residuals after the findings
  double inexact = 0;         ///< z that errors of the findings' fingerprints may leave
  std::vector<std::string> checks, warnings;
  int recordings = 0, modules = 0;
  /// What was recorded: wording and sections of the report. Never null.
  const DiagnosisSubject* subject = &kLiliesInTank;
  /// No recording was held out: `held_out` is of those that the fit rests on.
  std::vector<Shortfall> shortfalls;  ///< why recordings are insufficient, and what to record
  /// Further experiments for what is left open, best first; none where nothing is.
  std::vector<ProposedExperiment> next;
  bool nothing_held_out = false;
  double seconds = 0;
  std::string overlay;  ///< missing.toml; empty where nothing was found
  std::string flow_csv;
  /// Of the mismatch beyond chance on held-out recordings, in all groups where it is clear, the
  /// share that is removed; NaN where none is.
  double removed() const;
};

/// Carries a diagnosis through, or goes on with one that was stopped in `options.out`. Throws
/// Stopped and InputError.
Diagnosis diagnose(const Experiment& experiment, const DiagnosisOptions& options);

/// An earlier diagnosis in the same tank: its flow map, baseline, null experiments and fingerprints
/// serve for further recordings.
struct DiagnosedTank {
  Experiment experiment;  ///< with the same values of the model
  std::string directory;  ///< of its results; what is missing there is simulated
};
/// The same with an earlier diagnosis of the tank, by the same seed and budget. The recordings that
/// are fitted must be as many, of the same length, rate and number of modules. Throws InputError.
Diagnosis diagnose(const Experiment& experiment, const DiagnosedTank& tank,
                   const DiagnosisOptions& options);

/// The report, without its provenance.
ReportDocument diagnosis_report(const Diagnosis& diagnosis);
std::string diagnosis_text(const Diagnosis& diagnosis);
/// diagnosis.json (schema diagnosis/1).
std::string diagnosis_json(const Diagnosis& diagnosis);
/// Writes diagnosis.txt (the report), diagnosis.json, and where they are known missing.toml,
/// flow.csv, maps.csv, places.csv, ranking.csv and fit.csv. Returns the files' names. Throws
/// InputError.
std::vector<std::string> write_diagnosis(const Diagnosis& diagnosis, const ReportDocument& report,
                                         const std::string& dir);
/// Names of all files that write_diagnosis and draw_diagnosis may leave in a directory.
std::vector<std::string> diagnosis_files();

}  // namespace lilytank
