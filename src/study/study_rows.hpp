// What one row of a study says about copies, and how settings are compared.
#pragma once
#include <vector>

#include "lilytank/study_summary.hpp"

namespace lilytank {

/// [setting] its runs that finished, by replicate. As many settings as the table names or has.
std::vector<std::vector<const RunRow*>> finished_runs(const StudyTable& table);

/// Copies that a run had at some time, its modules' number at most.
int reached_copies(const RunRow& row);
bool reached_all(const RunRow& row);

/// Until when a run says how many copies were reached (s): after full yield nothing can follow.
double followed_until(const RunRow& row, double horizon);
/// The longest time to which some run of every setting was followed (s), `horizon` at most.
double watched_by_all(const std::vector<std::vector<const RunRow*>>& runs, double horizon);

/// Times to the k-th copy (s), censored at the end of a run; runs that could not make so many are
/// left out.
std::vector<Duration> durations_to(const std::vector<const RunRow*>& runs, int k);

/// Copies standing at the end, mean with Student's interval; where all runs have as many, with what
/// so few runs leave possible.
Estimate copies_of(const std::vector<const RunRow*>& runs);
/// Share of the runs that had all possible copies, of those that could make any; Wilson's interval.
Estimate full_yield_of(const std::vector<const RunRow*>& runs);
/// Copies/s over the time in which there were modules left to build with; Garwood's interval.
Estimate assembly_rate_of(const std::vector<const RunRow*>& runs);

/// How many copies a run must be able to make to say anything about a metric: k for time_k.
int copies_needed(const std::string& metric);

/// Fills in `all_pairs`, `survival_tests` and `pair_tests`.
void compare_settings(const std::vector<std::vector<const RunRow*>>& runs, StudySummary& summary);

}  // namespace lilytank
