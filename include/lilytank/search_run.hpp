// A search carried through in a directory: many evaluations at once, every value kept, any
// interruption survived.
//
// In the directory: evaluations.csv (every trial and its value), history.csv (one row an
// iteration), search.state (the checkpoint). After a kill at any moment the same call goes on, and
// all three files end with the bytes that an uninterrupted run would have given them.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "lilytank/job_control.hpp"
#include "lilytank/search.hpp"

namespace lilytank {

/// The value of a trial, lower is better, a function of the trial alone. Called from several
/// threads at once; what it throws ends the search.
using Objective = std::function<double(const Trial&)>;

/// Where a search is kept, and how many evaluations run at once.
struct SearchRunOptions : JobControl {
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
