// Assembly as chemistry: rates counted in worlds, a well-mixed stochastic model that runs on them
// [Gillespie, J. Phys. Chem. 81, 1977], and its export to other simulators of rules.
//
// The model knows assemblies by species and nothing of where they are: every pair of two species
// docks at one constant rate, every bond is evaluated at one constant rate.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lilytank/lattice.hpp"
#include "lilytank/world.hpp"

namespace lilytank {

/// Two species by Species::key, a <= b.
struct SpeciesPair {
  std::string a, b;  ///< keys in ascending order
  friend auto operator<=>(const SpeciesPair&, const SpeciesPair&) = default;
};

/// What was counted in worlds; tables of several worlds add up.
struct RateTable {
  /// Encounters of two species.
  struct Meeting {
    std::int64_t dockings = 0;  ///< latches between two assemblies of these species
    /// Time of pairs, s: n_a n_b dt, or n (n - 1) / 2 dt for a species with itself.
    double exposure = 0;
    std::map<std::string, std::int64_t> links;  ///< links that followed, by the rule's name
  };
  /// Changes within assemblies of one species.
  struct Standing {
    double exposure = 0;                          ///< time of assemblies, s: n dt
    std::map<std::string, std::int64_t> changes;  ///< unlinks and updates, by the rule's name
  };
  int worlds = 0;                            ///< simulation runs that were counted
  double seconds = 0;                        ///< simulated time of all runs, s
  std::map<SpeciesPair, Meeting> meetings;   ///< by pair of species
  std::map<std::string, Standing> standing;  ///< by Species::key
  std::int64_t evaluations = 0;  ///< evaluations of standing bonds; -1 where they were not counted
  double bond_seconds = 0;       ///< time that bonds stood, summed over bonds, s
  std::int64_t contacts = 0;     ///< new latches that were decided, by a link or a release
  double contact_seconds = 0;    ///< time that new latches waited for a decision, summed, s

  /// Adds counts and exposures.
  void add(const RateTable& other);
};
/// CSV `kind,rule,a,b,events,exposure_s`; keys have blanks for commas. Reads back the same.
std::string to_csv(const RateTable& table);
/// Throws InputError with line and column.
RateTable rate_table_from(const std::string& text, const std::string& file);

/// Follows the events of one world from its start. An assembly is what bonds connect.
class RateRecord {
 public:
  /// Begins with single modules. `rules` must outlive the record.
  RateRecord(const Ruleset& rules, int modules);
  /// Time passes (s) up to `time`, then the event happens.
  void observe(const Event& event, double time);
  /// After every step; takes the number of evaluations from the world.
  void observe(const World& world);
  /// Exchanges completed so far, those over new latches included, where there is no World.
  void count_evaluations(std::int64_t exchanges) { evaluations_ = exchanges; }
  /// The counts up to `time` (s).
  RateTable table(double time) const;

 private:
  struct Module {
    int label = 0, last = -1, assembly = 0;
    int partner[4] = {-1, -1, -1, -1}, partner_face[4] = {0, 0, 0, 0};
    double latched_at[4] = {-1, -1, -1, -1};
  };
  void pass(double time);
  void enter(const Event& event);
  void regroup(int module);
  int species_of_parts(int first, std::vector<int>& members);
  void end_contact(const Event& event);
  const Ruleset* rules_;
  std::vector<Module> modules_;
  std::vector<std::string> keys_;  // species by number
  std::map<std::string, int> numbers_;
  std::vector<int> count_;    // assemblies by species
  std::vector<int> species_;  // of the assembly in a slot (its lowest module)
  std::map<std::pair<int, int>, double> pair_seconds_;
  std::vector<double> seconds_;  // by species
  int bonds_ = 0;
  double bond_seconds_ = 0, time_ = 0;
  std::map<std::pair<int, int>, RateTable::Meeting> meetings_;
  std::map<int, std::map<std::string, std::int64_t>> changes_;
  std::int64_t contacts_ = 0, decisions_ = 0, evaluations_ = -1;
  double contact_seconds_ = 0;
};

/// Counts of one simulation run, and when its copies first stood.
struct MeasuredWorld {
  RateTable rates;                 ///< up to the end of the run
  std::vector<double> completion;  ///< when 1, 2, ... copies first stood, s
  bool diverged = false;           ///< ended early; the counts are valid up to then
};
/// Runs one world of `model` (which must have one ruleset) for `duration` (s). Throws Stopped.
MeasuredWorld measure_world(const Model& model, std::uint64_t seed, double duration,
                            const JobControl& control = {});
/// A measured world as text, to be kept: the table with rows `scenario` (its identity) and `copy`
/// (k, time). Reads back the same; throws InputError, also if it is of another scenario.
std::string to_csv(const MeasuredWorld& world, std::uint64_t identity);
/// Inverse of to_csv(). Throws InputError with line and column, also if the text is of another
/// identity.
MeasuredWorld measured_world_from(const std::string& text, const std::string& file,
                                  std::uint64_t identity);
/// The counts of a stored run up to its end, from its events.csv and summary.json. Throws
/// InputError, also for a run that is not over.
RateTable rates_of_run(const std::string& dir);

/// Of the standard tank, where nothing else was measured: links of one pair of faces that fit
/// (1/s), and evaluations of a standing bond (1/s); see docs/synthesis.md.
inline constexpr double kStandardFaceRate = 7.7e-4, kStandardEvaluationRate = 0.68;

/// A ruleset's reactions with their rates.
struct Kinetics {
  ReactionNetwork network;  ///< Species and reactions, explored from single modules
  /// Rate constants, 1/s, by reaction: of one pair of assemblies, or of one assembly.
  std::vector<double> rate;
  std::vector<std::int64_t> seen;  ///< events that each constant rests on
  /// Evaluations of a bond, 1/s; kStandardEvaluationRate where they were not counted.
  double evaluation_rate = 0;
  double face_rate = 0;  ///< links of one pair of faces that fit, 1/s, averaged over all reactions
};
/// Links: counts over exposure, drawn towards face_rate times places by the weight of one event, so
/// that what was never seen has a rate, too. Unlinks: p times the evaluation rate times places.
/// `table` may come from other p of the same rules. Throws InputError if it has no links.
Kinetics kinetics_of(const Ruleset& rules, const RateTable& table, int modules);
/// The same from two numbers, for tests and where nothing was measured.
Kinetics kinetics_of(const Ruleset& rules, double face_rate, double evaluation_rate, int modules);

/// One run of the well-mixed model.
struct GillespieOptions {
  int modules = 15;         ///< single modules at the start
  double duration = 14400;  ///< end of the run, s
  std::uint64_t seed = 1;   ///< key of the draws (Stream::gillespie)
};
/// Its outcome.
struct GillespieResult {
  std::vector<double> completion;  ///< when 1, 2, ... copies first stood, s
  std::vector<int> counts;         ///< assemblies of each species of the network at the end
  int copies = 0;                  ///< copies of the target at the end
  std::int64_t reactions = 0;      ///< reactions that fired
};
/// Reactions by Gillespie's direct method, from single modules. Draws depend on the seed and the
/// number of reactions so far only.
GillespieResult run_gillespie(const Kinetics& kinetics, const GillespieOptions& options);
/// One line per reaction: rule, species, rate constant and number of events.
std::string kinetics_text(const Ruleset& rules, const Kinetics& kinetics);

/// The rules for KaSim (Kappa 4) and BioNetGen: one agent with its control state, its connector l_n
/// and four faces; sixteen rules for each of ours, one for every way to turn two modules. Space is
/// left out: two modules join wherever they are, and what would overlap is not seen. Rates are of a
/// pair of faces and of a bond (1/s).
std::string to_kappa(const Ruleset& rules, double face_rate, double evaluation_rate, int modules);
/// The same for BioNetGen.
std::string to_bngl(const Ruleset& rules, double face_rate, double evaluation_rate, int modules);

}  // namespace lilytank
