// Rates counted in many worlds at once, each kept on the disk as soon as it is done.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "lilytank/job_control.hpp"
#include "lilytank/kinetics.hpp"

namespace lilytank {

/// How many simulations, of what length, kept where.
struct MeasureOptions : JobControl {
  int worlds = 20;          ///< number of simulation runs
  std::uint64_t seed = 1;   ///< run k has derived_seed(seed, k)
  double duration = 14400;  ///< simulated time of each run, s
  int threads = 0;          ///< runs at a time; 0: one per core
  std::string out;          ///< directory, made if absent, for world-<seed>-<k>.csv; empty: none
  /// Hash of everything that decides a run. Files in `out` of another identity are refused.
  std::uint64_t identity = 0;
};
/// The worlds in their order, those that are in `out` already read from there; the result does not
/// depend on threads or interruptions. Throws Stopped and InputError.
std::vector<MeasuredWorld> measure_worlds(const Model& model, const MeasureOptions& options);

}  // namespace lilytank
