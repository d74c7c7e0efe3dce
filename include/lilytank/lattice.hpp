// Rulesets without physics: what they can make, prove and get stuck in.
//
// Three views of one model, in which assemblies are cells on a lattice and modules latch by default
// on contact, exchange labels and apply the firmware's own match():
//  - the reaction network: species and reactions, explored until nothing new comes;
//  - the population graph: every state of M modules, where it can lead and where it cannot leave;
//  - the lattice world: M modules that meet at random, as a Monte Carlo.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lilytank/assembly_record.hpp"
#include "lilytank/job_control.hpp"
#include "lilytank/report.hpp"
#include "lilytank/ruleset.hpp"

namespace lilytank {

/// One thing that can happen to one assembly or to a pair of them.
struct Reaction {
  int rule = -1;  ///< index into Ruleset::rules
  RuleKind kind = RuleKind::link;
  std::vector<int> from;  ///< one species (unlink, update, closing a loop) or two
  std::vector<int> to;    ///< Species that result, by index, ascending
  /// Pairs of faces, or bonds, at which it happens, of one pair or assembly. A half: either module
  /// of two with equal labels may take the first of two right sides, each in half of the cases.
  double places = 1;
};

/// What a ruleset makes of single modules.
struct ReactionNetwork {
  std::vector<Species> species;     ///< [0] is a single module with label (0,0)
  std::vector<Reaction> reactions;  ///< in the order of exploration
  /// Joins that fit on the lattice but that no straight way leads to (see
  /// src/synthesis/steric.hpp); `to` is empty where nothing else makes what they would make.
  std::vector<Reaction> blocked;
  /// Indices of rules whose unlinking does not give back what their link rule needs, and how.
  std::map<int, std::string> unrestored;
  /// Whether the exploration ended by itself; false: a limit stopped it and there is more.
  bool closed = true;
  /// Index by Species::key, -1 if it is not there.
  int find(const std::string& key) const;
};

/// What is explored, and how far.
struct NetworkOptions {
  bool never = false;   ///< whether rules with p = 0 fire, too
  bool sterics = true;  ///< leave joins out that no straight way leads to
  int limit = 4096;     ///< most species to explore
  int largest = 64;     ///< most modules of one assembly
};
/// Explores from single modules. The state that each unlink rule leaves is checked against its link
/// rule on the way, whatever its p.
ReactionNetwork reaction_network(const Ruleset& rules, const NetworkOptions& options = {});

/// A set of states of M modules that, once entered, is never left.
struct EndState {
  /// Assemblies of each species of the network, in one of the set's states.
  std::vector<int> counts;
  int states = 1;         ///< states in the set; 1: nothing happens any more
  int copies = 0;         ///< most copies in any state of the set
  int fewest_copies = 0;  ///< fewest copies in any state of the set
};
/// All states of a population of modules, and where they end.
struct PopulationGraph {
  bool complete = true;        ///< false: more states than the limit, nothing is proved
  std::int64_t states = 0;     ///< number of states that can be reached
  int possible = 0;            ///< largest number of copies: floor(M / n)
  std::vector<EndState> ends;  ///< all sets of states that are never left
  /// Ends in which some copy is always missing.
  std::vector<EndState> deadlocks() const;
};
/// All states that `modules` single modules can come to, and where they end. Rules with p = 0 do
/// not fire, those with any p > 0 will at some time. Throws Stopped.
PopulationGraph population_graph(const Ruleset& rules, const ReactionNetwork& network, int modules,
                                 std::int64_t limit = 200000, const JobControl& control = {});

/// The smallest assembly that its rules cannot take apart any more; 0 if there is none.
int first_irreversible_size(const Ruleset& rules, const ReactionNetwork& network);
/// floor(M / s) > floor(M / n), s the smallest size that is irreversible, n the target's. Where it
/// does not hold, growth by one module cannot deadlock; where it does, it may.
bool deadlock_risk(int modules, int irreversible_size, int target_size);
/// Exactly, for growth by one module at a time in which everything smaller than s falls apart: some
/// b < floor(M / n) and k >= 1 have k s <= M - b n <= k (n - 1), so that all modules can be bound
/// in b copies and k assemblies that last.
bool serial_deadlock(int modules, int irreversible_size, int target_size);

/// One run of the Monte Carlo.
struct LatticeOptions : JobControl {
  int modules = 15;
  std::int64_t attempts = 100000;  ///< meetings of two assemblies; ends before that at full yield
  double evaluations = 0.2;  ///< mean number of evaluations of every bond per attempt, at most 1
  std::uint64_t seed = 1;
  bool to_the_end = false;  ///< whether it goes on after full yield, up to `attempts`
};
/// What a lattice world came to.
struct LatticeResult {
  std::int64_t attempts = 0;  ///< encounters that were tried
  /// Rules that fired, and latches that no rule made a bond.
  std::int64_t links = 0, unlinks = 0, refusals = 0;
  /// Encounters refused because no straight path leads to the docked pose.
  std::int64_t blocked = 0;
  std::int64_t crowded = 0;       ///< encounters refused because cells would have overlapped
  std::int64_t illegal = 0;       ///< appearances of assemblies that the network does not know
  std::string first_illegal;      ///< drawing of the first of these
  std::int64_t double_bonds = 0;  ///< meetings that made more than one bond (closures)
  std::int64_t restored = 0, unrestored = 0;  ///< joins that were undone on a copy, and compared
  /// Copies of the target at the end, and the most that the modules can form.
  int copies = 0, possible = 0;
  std::vector<std::int64_t> completion;  ///< attempts until 1, 2, ... copies stood
  std::map<std::string, int> standing;   ///< by species' drawing
};
/// Monte Carlo: two assemblies, a free face of a module of each, and if there is room they meet
/// there; all pairs of faces that then touch latch and are evaluated in random order, until each is
/// bonded or off. In between, bonds are evaluated. `network` says what is legal.
LatticeResult run_lattice(const Ruleset& rules, const ReactionNetwork& network,
                          const LatticeOptions& options);

/// All that `lilytank check` proves about a ruleset.
struct RulesetCheck {
  ReactionNetwork network;     ///< of the rules that can fire
  PopulationGraph population;  ///< only if modules > 0
  int modules = 0, target_size = 0;
  int irreversible_size = 0;      ///< first_irreversible_size() of the network
  bool target_reached = false;    ///< some species has the target's shape
  bool target_stable = false;     ///< no species of that shape can be taken apart
  std::vector<int> other_finals;  ///< Species of the target's size or more with another shape
  std::map<int, std::string> unrestored;
  std::vector<LatticeResult> lattice;
  /// Sentences, one a fault; empty: proved as far as `notes` say.
  std::vector<std::string> faults, notes;
};
/// What `lilytank check` computes.
struct CheckOptions : JobControl {
  int modules = 15;
  int lattice_runs = 0;  ///< Monte Carlo runs, with seeds derived from lattice.seed; 0: none
  LatticeOptions lattice;
};
/// Runs every check that the options ask for. A ruleset with faults is a result, not an error.
RulesetCheck check_ruleset(const Ruleset& rules, const CheckOptions& options = {});
/// The report of a check as a document. Provenance is the caller's.
ReportDocument check_report(const Ruleset& rules, const RulesetCheck& check);

}  // namespace lilytank
