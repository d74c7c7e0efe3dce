// What every search keeps of its iterations.
#pragma once
#include <vector>

#include "lilytank/search.hpp"
#include "search/state_text.hpp"
#include "search/tally.hpp"

namespace lilytank {

/// A record, but for its number, from the means of an iteration's points in any order.
IterationRecord record_of(std::vector<double> means, std::int64_t evaluations,
                          const Incumbent& best, double spread);
/// `u`: in the unit box.
Incumbent incumbent_of(const SearchSpace& space, const std::vector<double>& u, const Tally& tally);

/// Throws std::logic_error unless as many values were received as requested, and at least one.
void check_count(std::size_t received, std::size_t requested);

void save_history(StateWriter& out, const std::vector<IterationRecord>& history);
std::vector<IterationRecord> load_history(StateReader& in, std::size_t axes);

}  // namespace lilytank
