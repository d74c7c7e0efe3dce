// What is measured of a synthetic experiment before it is diagnosed, and the row that keeps it.
#pragma once
#include <optional>
#include <vector>

#include "finder/reference_ensemble.hpp"

namespace lilytank {

struct MeasuredExperiment {
  int regression = -1;  ///< the catalogue's effect that a sparse regression finds; -1: none
  Vectors observed;
  ScoreDetails details;
};

/// The row of a stage of simulations: the sizes and details, the summary, the scores.
std::vector<double> row_of(const MeasuredExperiment& m);
/// Nothing of an experiment that diverged: its row is empty.
std::optional<MeasuredExperiment> measured_of(const std::vector<double>& row);

}  // namespace lilytank
