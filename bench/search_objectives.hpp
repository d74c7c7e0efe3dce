// What searches are measured on: a function of point and replicate, and its truth.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lilytank/search.hpp"

namespace lilytank::bench {

struct SearchObjective {
  std::string name;
  SearchSpace space;
  std::function<double(const Trial&)> value;  ///< noisy, a function of the trial alone
  /// Without noise; 0 at the lowest point, 1 on average over the box.
  std::function<double(const std::vector<double>&)> truth;
};

/// How a case of the yardstick is made for each seed: lowest point and noise differ.
struct SearchCase {
  std::string function;  ///< a name of search_functions()
  int axes = 0;
  std::int64_t budget = 0;
  int particles = 0;
  double noise = 0;  ///< standard deviation, as a share of the function's mean over the box
};

/// "sphere", "corner" (a sphere around a corner of the box), "ellipsoid" (weights 1 to 1000),
/// "rosenbrock", "rastrigin".
std::vector<std::string> search_functions();
/// Normal noise, half of whose variance comes from the replicate alone: common random numbers
/// cancel that half.
SearchObjective search_objective(const SearchCase& what, std::uint64_t seed);

}  // namespace lilytank::bench
