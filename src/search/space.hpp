// The box that is searched, seen as the unit box of its axes' (log) ranges.
#pragma once
#include <string>
#include <vector>

#include "lilytank/search.hpp"
#include "search/state_text.hpp"

namespace lilytank {

/// Throws InputError on an empty space, a name that is empty, given twice or no word, or bounds
/// that are not finite, not in order, or not above 0 on a log scale.
void check_space(const SearchSpace& space);
/// Throws InputError unless `point` has a value within the bounds for each axis; `what` it is.
void check_point(const SearchSpace& space, const std::vector<double>& point,
                 const std::string& what);

/// The point at u, each in [0, 1]; never outside the bounds.
std::vector<double> from_unit(const SearchSpace& space, const std::vector<double>& u);
/// The inverse, but for rounding.
std::vector<double> to_unit(const SearchSpace& space, const std::vector<double>& point);

void save_space(StateWriter& out, const SearchSpace& space);
/// Throws InputError on what check_space refuses.
SearchSpace load_space(StateReader& in);

}  // namespace lilytank
