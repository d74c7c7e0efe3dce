// A search carried through in a directory: many evaluations at once, every value kept, any
// interruption survived.
//
// In the directory: evaluations.csv (every trial and its value), history.csv (one row an
// iteration), search.state (the checkpoint). After a kill at any moment the same call goes on, and
// all three files end with the bytes that an uninterrupted run would have given them.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "lilytank/search.hpp"

namespace lilytank {

/// The value of a trial, lower is better, a function of the trial alone; nothing if it was given up
/// because of the stop signal. Called from several threads at once; what it throws ends the search.
using Objective = std::function<std::optional<double>(const Trial&)>;

/// How far a search has come.
struct SearchProgress {
  /// Fraction of the budget spent.
  double done = 0;
  std::int64_t evaluations = 0;  ///< so far, all calls together
  /// Iterations that are over.
  int iteration = 0;
  /// The incumbent's mean; NaN before the first batch.
  double best = 0;
  double evaluations_per_second = 0;  ///< in this call, of wall time
};

/// Where a search is kept, and how many evaluations run at once.
struct SearchRunOptions {
  /// Output directory, made if absent.
  std::string dir;
  /// Says what is searched: objective, data, settings, in any words. The search's own space,
  /// options and seed are compared anyway. A directory with another search is refused.
  std::string identity;
  /// Replace another search's files.
  bool force = false;
  /// Whether the caller holds the lock of `dir`; a second one in the same process would fail.
  bool locked = false;
  /// Evaluations at a time; 0: one a core.
  int threads = 0;
  /// Set by a signal: evaluations under way are abandoned, finished ones are kept.
  const std::atomic<bool>* stop = nullptr;
  /// Called by one thread at a time.
  std::function<void(const SearchProgress&)> progress;
};

/// The search after the call.
struct SearchRunResult {
  std::unique_ptr<Search> search;  ///< at its end
  /// Trials evaluated in this call.
  std::int64_t evaluated = 0;
};

/// Carries `search`, new from make_swarm or make_cma_es, to its end, or goes on where an earlier
/// call with the same search stopped. Throws Stopped, InputError if the directory holds another
/// search, is in use by another process, or its files are damaged or cannot be written.
SearchRunResult run_search(std::unique_ptr<Search> search, const Objective& objective,
                           const SearchRunOptions& options);

/// history.csv: iteration, evaluations, best, median, worst, spread, then the incumbent's value on
/// each axis under the axis' name.
std::string history_text(const Search& search);

}  // namespace lilytank
