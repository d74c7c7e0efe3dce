// The experiment that would distinguish what recordings leave open.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "lilytank/coverage.hpp"

namespace lilytank {

/// Further recordings, and how much they are expected to show.
struct ProposedExperiment {
  int modules = 0;           ///< Lilies in the tank
  double minutes = 0;        ///< of Lilies
  int balls = 0;             ///< in the tank, without Lilies
  double ball_minutes = 0;   ///< of balls
  double power = 1;          ///< of the pumps, relative to the recordings
  bool repeats = false;      ///< the same Lilies in the same water
  double information = NAN;  ///< nat, of the pair that it distinguishes least; NaN: not known
  std::string pair;          ///< "pair_attraction or lubrication"; "": not known
  double relative = NAN;     ///< information per minute over that of repeating

  /// Another flow: balls and Lilies are diagnosed alone, not together with the recordings.
  bool alone() const { return power != 1; }
  double all_minutes() const { return minutes + ball_minutes; }
  /// "12 min of 1 Lily"
  std::string text() const;
};

/// What meets the requirements that recordings fall short of.
ProposedExperiment to_meet(const std::vector<Shortfall>& shortfalls);

/// next_experiment.toml: an overlay of the experiment `name` that simulates the proposal, and that
/// is an experiment once the new recordings are in the files that it names.
std::string next_experiment_toml(const std::string& name, const ProposedExperiment& proposed);

}  // namespace lilytank
