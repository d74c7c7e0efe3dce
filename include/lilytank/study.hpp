// Many worlds at once: every combination of the axes' values, many replicates of each, on one
// machine or on many, in any order, through any number of interruptions, to one table.
//
// A world is never split over threads, and a row is a function of its scenario and its seed, so the
// table does not depend on threads, shards, order or interruptions.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lilytank/job_control.hpp"
#include "lilytank/scenario.hpp"
#include "lilytank/statistics.hpp"
#include "lilytank/study_table.hpp"

namespace lilytank {

/// Calls work(i) once for each i in [0, count), up to `threads` at a time (0: one a core), in no
/// particular order. After an exception of work no further one is begun; it is thrown on once the
/// rest have ended. So is Stopped where `control` is stopped before the last one is begun.
void for_each_world(int count, int threads, const std::function<void(int)>& work,
                    const JobControl& control = {});

/// Replicates are added in rounds until the half width of a metric's 95 % confidence interval is at
/// most this. A decision after m replicates looks at replicates 0 .. m-1 of its setting and at
/// nothing else.
struct StoppingRule {
  /// As in is_metric(): "copies", "time_2", ...
  std::string metric;
  double half_width = 0;  ///< in the metric's unit
  int min = 0, max = 0;   ///< replicates
  /// Replicates between decisions.
  int round = 0;
};

/// One combination of the axes' values.
struct Setting {
  /// "count=15, p_e", for legends.
  std::string label;
  /// The axes' values as in table.csv: "0.3", "p_e". Numbers are in the unit of the scenario's key,
  /// whatever unit the study file gives them in: SI, but % for flow.pump_power.
  std::vector<std::string> texts;
  /// The same as numbers; for words and overlays, their position in the study file.
  std::vector<double> values;
  /// Simulated time of a run, s.
  double duration = 0;
  /// Hash of the resolved scenario with run.seed = 0.
  std::uint64_t identity = 0;
};

/// All that decides what is run and how the table looks. It is stored as study.toml.
struct StudyPlan {
  /// From the study file.
  std::string name;
  /// Files and --set values of the scenario, as documentation.
  std::vector<std::string> scenarios, sets;
  /// Key of the replicates' seeds.
  std::uint64_t seed = 1;
  /// Replicates of each setting; with a stopping rule, the upper bound.
  int replicates = 0;
  /// Without a stopping rule the number of replicates is fixed.
  std::optional<StoppingRule> stop;
  /// Ends a run once all possible copies stand and no rule can change them. Rows are the same as
  /// without it, except that a later divergence or illegal assembly is not seen. Not stored: it
  /// does not distinguish studies.
  bool until_settled = false;
  /// Names: dotted paths, or those of overlay axes.
  std::vector<std::string> axes;
  /// The last axis changes fastest.
  std::vector<Setting> settings;

  /// The longest duration of a setting, s.
  double horizon() const;
  /// Equal for studies that do the same runs, up to how many replicates of each.
  std::uint64_t identity() const;
  /// Seed of a replicate, the same for all settings (common random numbers). Below 2^59, the bound
  /// of `lilytank run --seed`.
  std::uint64_t seed_of(int replicate) const;
  /// 16 hex digits: a function of the setting's identity and the seed.
  std::string id_of(int setting, int replicate) const;
};

/// A study that can be run: its plan, and where the scenarios come from.
class Study {
 public:
  /// Reads a study file; `sets` ("path=value") are laid over every setting; run.seed is the seed of
  /// the study. Every setting is built once, so mistakes come to light here. Throws InputError.
  explicit Study(const std::string& file, const std::vector<std::string>& sets = {});
  ~Study();
  Study(Study&&) noexcept;
  /// What the file says, resolved.
  const StudyPlan& plan() const;
  /// Builds a setting's scenario anew, with run.seed = 0. Throws InputError if files have changed
  /// since the study was read.
  Scenario scenario(int setting) const;
  /// All files that are read: its own, scenarios, overlays and what these name.
  std::vector<std::string> inputs() const;

 private:
  struct Source;
  std::unique_ptr<const Source> source_;
};

/// A part of a study: runs whose id leaves `index` when divided by `count`.
struct Shard {
  /// From 0; the user's "1/5" is 0.
  int index = 0;
  int count = 1;
  /// What it was taken from: "--shard", "SLURM_ARRAY_TASK_ID".
  std::string origin;
  /// Whether a run belongs to this shard.
  bool holds(const std::string& id) const;
};
/// From "2/5". Throws InputError unless 1 <= 2 <= 5.
Shard shard_from(const std::string& text);
/// Of a Slurm job array, an MPI launcher or srun, or the whole. `variable` looks up the
/// environment, null where there is none. Throws InputError if what it finds makes no sense.
Shard shard_of_environment(const std::function<const char*(const char*)>& variable);

/// Where a study is kept, and which part of it runs here.
struct StudyOptions : JobControl {
  std::string out;  ///< directory, made if absent
  Shard shard;
  /// Simulations at a time; 0: one per core.
  int threads = 0;
  /// Replace another study's files.
  bool force = false;
  /// Called once everything is checked, with how many runs are to be done now, before any is.
  std::function<void(int runs)> begin;
};

/// How a call of run_study() ended.
struct StudyResult {
  /// All runs of all shards are there.
  bool complete = false;
  /// The stopping rule needs other shards' rows before more can be run here.
  bool waiting = false;
  int runs = 0;  ///< of this call
  /// Diverged, of all runs in the directory.
  int failed = 0;
};

/// Does what is missing of a study, or of a shard of it. Throws Stopped, InputError if a world
/// cannot be set up, or if `out` holds another study, a run, or files that would be overwritten,
/// and not `force`.
StudyResult run_study(const Study& study, const StudyOptions& options);

/// What a study's directory holds.
struct StoredStudy {
  StudyPlan plan;
  /// The runs that there are. A setting's replicates beyond those that the stopping rule asks for
  /// are left out.
  StudyTable table;
  /// Replicates of one setting.
  struct Count {
    int done = 0, failed = 0;
    /// Replicates that the plan or the stopping rule asks for, as far as is known.
    int wanted = 0;
    /// The stopping rule has spoken; always for fixed numbers.
    bool decided = false;
  };
  std::vector<Count> counts;  ///< one a setting
  bool complete = false;
};
/// Throws InputError if the directory holds no study or its files are damaged.
StoredStudy load_study(const std::string& dir);
/// The runs of `plan` in a directory, none if there is no directory. Throws InputError if it holds
/// another study.
StoredStudy load_study(const std::string& dir, const StudyPlan& plan);

/// table.csv: one row a run, sorted by setting and replicate. Nothing in it depends on the clock,
/// the machine, threads, shards or order.
std::string table_text(const StoredStudy& study);
/// Writes table.csv into the directory.
void write_table(const StoredStudy& study, const std::string& dir);

/// Whether `name` is a metric: copies, full_yield, assembly_rate, time_1, time_2, ...
bool is_metric(const std::string& name);
/// Unit of a metric: "1", "s" or "1/s".
std::string metric_unit(const std::string& name);
/// A metric of one setting's runs, diverged ones left out, with its 95 % interval. As in
/// SettingSummary: copies standing at the end; full_yield, of the runs that could make a copy;
/// assembly_rate (1/s). And time_k, the mean time to the k-th copy restricted to `duration` (s).
Estimate metric_estimate(const std::string& name, const std::vector<const RunRow*>& runs,
                         double duration);

/// What a batch script for Slurm is made from.
struct SlurmJob {
  std::string program, study;     ///< paths
  std::vector<std::string> sets;  ///< as given to --set
  std::string name, out;
  int shards = 1, cpus = 8;
  std::string time = "04:00:00";  ///< Slurm's form, of one task
};
/// A script for sbatch: an array with one shard a task, taken up again after a time limit, and how
/// to submit it and the merging after it. No name becomes a command or a directive: each is quoted,
/// and the job's name has letters, digits, '_', '.' and '-' only. Throws InputError if the time is
/// not of Slurm's form.
std::string slurm_script(const SlurmJob& job);

}  // namespace lilytank
