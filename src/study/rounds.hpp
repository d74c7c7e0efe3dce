// How many replicates a setting gets.
#pragma once
#include <vector>

#include "lilytank/study.hpp"

namespace lilytank {

struct RequiredRuns {
  int replicates = 0;    ///< that many are required, at least
  bool decided = false;  ///< and no more
};

/// `rows`: a setting's runs by replicate, null where missing. Asks the stopping rule at `min`
/// replicates and after every further round for as long as all of those are there; a function of
/// these rows alone, whoever made them and when.
RequiredRuns required_replicates(const StudyPlan& plan, int setting,
                                 const std::vector<const RunRow*>& rows);

}  // namespace lilytank
