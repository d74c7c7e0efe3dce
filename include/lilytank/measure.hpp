// Rates counted in many worlds at once, each kept on the disk as soon as it is done.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lilytank/kinetics.hpp"

namespace lilytank {

struct MeasureOptions {
  int worlds = 20;
  std::uint64_t seed = 1;      ///< world k has derived_seed(seed, k)
  double duration = 14400;     ///< s, of each world
  int threads = 0;             ///< 0: one a core
  std::string out;             ///< directory, made if absent, for world-<seed>-<k>.csv; empty: none
  std::uint64_t identity = 0;  ///< of what decides a world; files of another one are refused
  const std::atomic<bool>* stop = nullptr;    ///< set by a signal: running worlds are abandoned
  std::function<void(double done)> progress;  ///< share of worlds, called by one thread at a time
};
/// The worlds in their order, those that are in `out` already read from there; the result does not
/// depend on threads or interruptions. Stopped worlds have `stopped` set. Throws InputError.
std::vector<MeasuredWorld> measure_worlds(const Model& model, const MeasureOptions& options);

}  // namespace lilytank
