// The study that compares an optimum with other overlays.
#pragma once
#include <string>
#include <vector>

#include "optimize/source.hpp"

namespace lilytank {

/// Builds every overlay of [compare] over the scenario once. Throws InputError where the study that
/// compares them would, so that no search is run in vain.
void check_comparison(const Optimization::Source& source);

/// A study file, and the labels of the overlays that it leaves out: they say what the optimum says.
struct OptimumComparison {
  std::string text;
  std::vector<std::string> left_out;
};
/// Of the overlay `optimum`, first, with those of [compare]; for a study file beside it.
OptimumComparison comparison_with(const Optimization::Source& source, const std::string& optimum);

}  // namespace lilytank
