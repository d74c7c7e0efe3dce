// Numbers of a model by maximum likelihood of its innovations, and how well fits predict what they
// have not seen.
#pragma once
#include <atomic>

#include "bodies/filter.hpp"

namespace lilytank::bodies {

/// Runs that share coefficients, with the parts that are left out in turn.
struct Group {
  std::string name;
  std::vector<const BodyRun*> runs;
  Typical typical;
  std::vector<int>
      fold;  ///< of every seen coordinate in the innovations' order; -1: never left out
  std::vector<int> block;  ///< of neighbours in time, for standard errors
  int folds = 0, blocks = 0;
  double step = 0;                 ///< s, between samples: the median
  std::vector<double> penalty_at;  ///< centre of the weak prior of own numbers, as packed
};

/// Folds: runs marked held out; else whole runs where there are several; else every fourth block of
/// time.
Group make_group(const BodyExperiment& experiment, const std::string& name,
                 const std::vector<const BodyRun*>& runs);

struct Fitted {
  BodyModel model;
  std::vector<double> numbers;    ///< as packed
  std::vector<double> deviation;  ///< their standard errors (of the packed numbers)
  double likelihood = 0;          ///< log, of all fitted samples
  int lost = 0;                   ///< coordinates whose prediction was not finite
  /// Log-likelihood of held-out samples, by block; empty: not computed.
  std::vector<double> held_out;
  double held_out_sum() const;
  /// Whether the model's predictions of these samples are finite, so that they have a likelihood.
  bool usable() const;
};

/// Goes uphill from the model's numbers by Fisher's scoring: numeric derivatives, Levenberg's
/// damping. `held`: noise and pushes stay as they are; `rounds`: steps at most.
Fitted fit_group(const Group& group, const BodyModel& from, bool held = false, int rounds = 16);

/// Leaves out one fold after the other, fits the rest again and scores what was left out.
void leave_folds_out(const Group& group, Fitted& fitted);

/// A first model of the baseline's terms: noise, pushes and their memory by size.
BodyModel first_model(const BodyExperiment& experiment, const Group& group);

}  // namespace lilytank::bodies
