// Rows of numbers that are costly to compute, each a function of its index alone: computed by many
// threads and kept in a file.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lilytank/job_control.hpp"

namespace lilytank {

struct KeptRows : JobControl {
  std::string file;            ///< made if absent; empty: nothing is kept
  std::uint64_t identity = 0;  ///< of all that the rows depend on
  int threads = 0;             ///< 0: one a core
};

/// One file of rows: how many, and each as a function of its index.
struct RowSet {
  std::string file;  ///< as that of KeptRows
  int count = 0;
  std::function<std::vector<double>(int)> work;
};

/// Rows 0 .. count - 1, those that the file has read from it. A row may be empty (a world that
/// diverged); numbers that are not finite become NaN. Throws Stopped, and InputError if the file is
/// damaged or of another identity; a last row cut by a kill is computed again.
std::vector<std::vector<double>> kept_rows(const KeptRows& kept, int count,
                                           const std::function<std::vector<double>(int)>& work);
/// The same of several files. All rows are computed in one loop: no thread waits for the last row
/// of each file. `kept.file` does not count.
std::vector<std::vector<std::vector<double>>> kept_row_sets(const KeptRows& kept,
                                                            const std::vector<RowSet>& sets);

}  // namespace lilytank
