// The searches that are measured against each other.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "search_objectives.hpp"

namespace lilytank::bench {

/// What a search ended with.
struct SearchOutcome {
  std::vector<double> point;
  double told = 0;  ///< the mean that it believes in
  std::int64_t evaluations = 0;
};

struct SearchContestant {
  std::string name;
  std::function<SearchOutcome(const SearchObjective&, const SearchCase&, std::uint64_t seed)> run;
};

/// Our own.
std::vector<SearchContestant> own_contestants();
/// pagmo's, where this was built with it (LILYTANK_WITH_PAGMO).
std::vector<SearchContestant> pagmo_contestants();

}  // namespace lilytank::bench
