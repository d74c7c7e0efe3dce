// Rows of numbers that are costly to come by, each a function of its index alone: evaluated by many
// threads and kept in a file as they come, so that a kill loses seconds.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lilytank {

struct KeptRows {
  std::string file;            ///< made if absent; empty: nothing is kept
  std::uint64_t identity = 0;  ///< of all that the rows depend on
  int threads = 0;             ///< 0: one a core
  const std::atomic<bool>* stop = nullptr;
  std::function<void(int done, int count)> progress;  ///< called by one thread at a time
};

/// Rows 0 .. count - 1, those that the file has read from it. A row may be empty (a world that
/// diverged); numbers that are not finite become NaN. Throws Stopped once `stop` is set, InputError
/// if the file is damaged or of another identity; a last row cut by a kill is done again.
std::vector<std::vector<double>> kept_rows(const KeptRows& kept, int count,
                                           const std::function<std::vector<double>(int)>& work);

}  // namespace lilytank
