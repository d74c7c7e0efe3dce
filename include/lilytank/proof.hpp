// Is a diagnosis to be trusted? Sealed experiments, diagnosed blind, and then compared with their
// key.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lilytank/diagnosis.hpp"

namespace lilytank {

struct Proof;

struct ProofOptions {
  int worlds = 100;
  std::string only;         ///< null, named, two or unnamed: leaves out those of another kind
  double minutes = 4;       ///< of a recording; an experiment has three
  double ball_minutes = 0;  ///< of a recording of balls, of which there are three; 0: as `minutes`
  int modules = 15;         ///< in a recording of Lilies
  bool known_flow = false;  ///< no balls: the diagnosis uses the true flow
  /// true: pumps, inlets and the parameters that calibrations estimate are drawn from the seed.
  /// false: the built-in tank, with the parameters at which the diagnosis starts.
  bool drawn_tank = false;
  /// All recordings are of bodies that Box2D moves, in a flow that is interpolated otherwise, seen
  /// by a camera with pixels. Throws InputError if this program was built without Box2D.
  bool foreign = false;
  std::string latches;               ///< file of the modules' rules; empty: their latches are off
  bool event_log = false;            ///< with latches: the modules' events are logged
  std::vector<std::string> effects;  ///< the catalogue's effects that are drawn; empty: all
  double sizes = 1;  ///< factor on the effects' amplitudes, more than 0 and at most 1
  /// Groups are split by the experiments that the diagnosis proposes, and by repeating.
  bool closed_loop = false;
  int modelled = 10;  ///< correctly diagnosed experiments whose model is fitted as well, at most
  /// Of each; its directory is the proof's. Recordings that are insufficient are the verdict,
  /// unless `uncertified`.
  DiagnosisOptions diagnosis;
  /// Called once with the SHA-256 of the key, before anything is diagnosed.
  std::function<void(const std::string& hash)> sealed;
  /// Called after every world that was judged, with all of them so far.
  std::function<void(const Proof& so_far)> judged;
};

/// A 95 % interval of a model that was fitted, and the truth.
struct ProofInterval {
  std::string path;
  double truth = 0, value = 0, low = 0, high = 0;
  bool holds() const { return low <= truth && truth <= high; }
  /// Of an effect or a law, not of the baseline.
  bool of_effect(const std::vector<std::string>& effects) const;
};

/// A finding: an effect, or others that are not distinguished from it.
struct ProofFinding {
  std::string effect;
  std::vector<std::string> alternatives;
  std::string variable;
  double z = 0;
  bool names(const std::string& of) const;
};

/// A group of effects and the further recordings that split it, by proposals and by repeating.
struct ProofLoop {
  std::vector<std::string> group;  ///< the effects that are predicted, the reported one first
  std::vector<std::string> texts;  ///< of the proposals that were recorded
  double minutes = 0, repeat_minutes = 0;
  bool split = false, repeat_split = false;
  std::string left, repeat_left;  ///< the effect that explains the recordings best in the end
};

/// One sealed experiment: its key, and what was said of it.
struct ProofWorld {
  std::string kind;                  ///< null, named, two, unnamed
  std::vector<std::string> effects;  ///< of the catalogue; of unnamed ones the variable
  /// Deviations between the means of experiments with this very effect and without it, both
  /// calibrated without it; of two the weaker one's; 0: nothing is there.
  double expected_z = 0;
  Verdict verdict = Verdict::complete;
  std::vector<ProofFinding> findings;   ///< strongest first; none of complete
  std::vector<Requirement> shortfalls;  ///< of insufficient ones; then nothing below is known
  /// Of those that were modelled, and the baseline's of complete ones that were so called.
  std::vector<ProofInterval> intervals;
  /// Of those that were modelled: the share of the mismatch that the model removes on recordings
  /// that had no part in it (Diagnosis::removed).
  double removed = 0, gain = 0, gain_low = 0;  ///< gain: nat, one step ahead, and its lower bound
  std::optional<ProofLoop> loop;               ///< of groups, where requested
  /// What simpler methods make of the same recordings: the effect that a sparse regression of
  /// differentiated positions finds strongest ("" for none), and how far the MSD is off.
  std::string regression;
  double displacement = 0;
  /// null: complete; named: the strongest finding's name, or one not distinguished from it; two:
  /// each in a finding; unnamed: so called, right variable.
  bool right() const;
  /// Not right and not wrong: too little was recorded.
  bool insufficient() const { return verdict == Verdict::insufficient; }
  /// Whether a name was reported that is in no way the key's.
  bool wrong_name() const;
};

struct Proof {
  std::string key;   ///< a line a world: kind, effect, its held numbers, amplitudes, factors
  std::string hash;  ///< SHA-256 of the key
  /// Which tank, balls and nulls they share, in words: the same text, the same tank. "": unknown.
  std::string tank;
  std::string dir;                 ///< that it was read from; "" of a new one
  std::size_t sealed = 0;          ///< worlds of the key
  std::vector<ProofWorld> worlds;  ///< those that were judged, from the first
};

/// Makes or draws a tank, its balls and sealed experiments in it (other steps than the diagnosis's,
/// gusts point by point, parameters up to 8 % off), diagnoses them blind and opens the key. One
/// tank's nulls and fingerprints serve all of them. Throws Stopped, InputError.
Proof prove(const ProofOptions& options);

/// The proof in its directory, if all of its experiments were judged; nothing is simulated. Throws
/// InputError if its files are damaged.
std::optional<Proof> finished_proof(const ProofOptions& options);

/// Of one proof, or of several with tanks of their own together: rates with binomial intervals, by
/// kind and by expected z; what was taken for what.
ReportDocument proof_report(std::span<const Proof> proofs);
std::string proof_text(std::span<const Proof> proofs);
/// One row a world.
std::string proof_csv(const Proof& proof);
/// One row an interval.
std::string proof_intervals_csv(const Proof& proof);
/// One row a group that was split, or was to be.
std::string proof_loops_csv(const Proof& proof);
/// A sealed experiment with something missing, as a point of a figure.
struct ProofPoint {
  enum class Outcome { right, silent, wrong_name, other };
  std::string row;  ///< the effect; "two effects", "a law of no effect"
  double expected_z = 0;
  Outcome outcome = Outcome::other;
};
/// How often experiments of a range of expected z are diagnosed correctly, with its 95 % interval.
struct ProofPower {
  double z = 0;  ///< geometric mean of the range's experiments
  int right = 0, all = 0;
  double low = 0, high = 0;
};
/// What figures show of a proof.
struct ProofFigures {
  static constexpr double kLeastZ = 0.5;  ///< what is expected of less stands here
  std::vector<ProofPoint> points;
  std::vector<ProofPower> named, two, unnamed;  ///< by rising z
  /// Errors of parameters in half widths of their 95 % intervals, sorted: the baseline's (of
  /// complete experiments, too), and those
  /// of effects and laws.
  std::vector<double> baseline_errors, effect_errors;
};
/// Of one proof or several together.
ProofFigures proof_figures(std::span<const Proof> proofs);
/// Names of all files that a proof may leave in its directory.
std::vector<std::string> proof_files();
/// Writes what its directory holds before the key is opened: proof.txt, proof.csv, tank.txt,
/// intervals.csv and, where groups were split, closed_loop.csv. Throws InputError.
void write_proof(const Proof& so_far, const std::string& dir);
/// Removes key.txt of other experiments of the same tank; writes the proof's.
void forget_other_key(const std::string& dir, const std::string& hash);
void open_key(const Proof& proof, const std::string& dir);
/// A finished proof from its directory's key.txt, proof.csv, intervals.csv
/// and, if there were groups to split, closed_loop.csv. Throws InputError
/// where one is absent, damaged, or not of that key.
Proof read_proof(const std::string& dir);

}  // namespace lilytank
