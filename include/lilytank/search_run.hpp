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

struct SearchProgress {
  double done = 0;                    ///< share of the budget
  std::int64_t evaluations = 0;       ///< so far, all calls together
  int iteration = 0;                  ///< that are over
  double best = 0;                    ///< the incumbent's mean; NaN before the first batch
  double evaluations_per_second = 0;  ///< in this call, of wall time
};

struct SearchRunOptions {
  std::string dir;  ///< made if absent
  /// Says what is searched: objective, data, settings, in any words. The search's own space,
  /// options and seed are compared anyway. A directory with another search is refused.
  std::string identity;
  bool force = false;                                   ///< replace another search's files
  int threads = 0;                                      ///< evaluations at a time; 0: one a core
  const std::atomic<bool>* stop = nullptr;              ///< set by a signal
  std::function<void(const SearchProgress&)> progress;  ///< called by one thread at a time
};

struct SearchRunResult {
  std::unique_ptr<Search> search;  ///< as far as it came
  bool stopped = false;            ///< by the signal, before its budget was spent
  std::int64_t evaluated = 0;      ///< trials evaluated in this call
};

/// Carries `search`, new from make_swarm or make_cma_es, to its end, or goes on where an earlier
/// call with the same search stopped. Throws InputError if the directory holds another search, is
/// in use by another process, or its files are damaged or cannot be written.
SearchRunResult run_search(std::unique_ptr<Search> search, const Objective& objective,
                           const SearchRunOptions& options);

/// history.csv: iteration, evaluations, best, median, worst, spread, then the incumbent's value on
/// each axis under the axis' name.
std::string history_text(const Search& search);

}  // namespace lilytank
