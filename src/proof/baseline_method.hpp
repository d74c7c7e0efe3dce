// What a simpler method says of the same recordings: what a proof measures a diagnosis against.
#pragma once
#include <vector>

#include "scores/score_plan.hpp"

namespace lilytank {

/// A term that a regression kept, and its t by ordinary least squares.
struct KeptTerm {
  int effect = -1;  ///< index into the plan's effects; -1: none was kept
  double t = 0;
};

/// Accelerations by second differences of positions, less the baseline's at velocities by first
/// differences, regressed on the forces of all effects; terms without significance are dropped and
/// the rest fitted again until all that are left have it [the sequential thresholding of Brunton,
/// Proctor and Kutz, PNAS 113, 2016]. The strongest term that is left. Effects without a mean force
/// cannot be among them.
KeptTerm sparse_regression(const ScorePlan& plan, const std::vector<Recording>& recordings);

}  // namespace lilytank
