// Rulesets against each other, each with probabilities of its own.
#pragma once
#include <memory>

#include "optimize/source.hpp"

namespace lilytank {

struct RaceOutcome {
  const Optimization::Source* winner = nullptr;  ///< null: no race was requested
  std::vector<double> start;                     ///< its best point
  const Optimization::Source* own = nullptr;     ///< the scenario's, where another one won
  std::vector<RaceEntry> entries;
  double share = 0;  ///< of all evaluations, the final search's included, that the race takes
};

/// What races: `source` with its own ruleset, then with those of the target's other plans. Throws
/// InputError if the race could not be run to its end with one of them.
std::vector<std::unique_ptr<const Optimization::Source>> contestants_of(
    const Optimization::Source& source);
/// What its rounds take.
std::int64_t race_evaluations(int rulesets, std::int64_t each);

/// Successive halving [Jamieson and Talwalkar, AISTATS 2016]: the better half of each round goes on
/// with twice the evaluations. In the first rounds every ruleset is judged at its start, with the
/// same seeds; once they are enough, each has a search of its own, begun at its best point so far.
/// Writes <out>/rulesets, <out>/race and <out>/race.csv; resumes after an interruption. Throws
/// Stopped.
RaceOutcome run_race(const Optimization::Source& source, const OptimizationOptions& options);

}  // namespace lilytank
