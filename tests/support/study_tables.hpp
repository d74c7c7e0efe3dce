// Study tables of known processes, for tests of what is made of them.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lilytank/random.hpp"
#include "lilytank/study_table.hpp"

namespace lilytank::sample {

/// A finished run with copies completed at `completion` (s); it ends at `duration`.
inline RunRow run_row(int setting, int replicate, std::vector<double> completion,
                      double duration = 100, int possible = 3) {
  RunRow row;
  row.id = std::to_string(1000 * setting + replicate);
  row.setting = setting, row.replicate = replicate;
  row.seed = derived_seed(11, static_cast<std::uint64_t>(replicate));
  row.values = {static_cast<double>(setting)};
  row.duration = duration, row.possible = possible;
  row.copies = static_cast<int>(completion.size());
  row.completion = std::move(completion);
  return row;
}

/// Settings whose copies follow one another after exponential times of the given rates (1/s), cut
/// at `horizon` (s). Equal replicates share the random number of each even copy.
inline StudyTable exponential_study(const std::vector<double>& rates, int replicates,
                                    double horizon, int possible = 3) {
  StudyTable table;
  table.name = "exponential";
  table.axes = {"rate"};
  table.horizon = horizon;
  for (std::size_t s = 0; s < rates.size(); ++s) {
    const int setting = static_cast<int>(s);
    table.labels.push_back("rate = " + std::to_string(rates[s]).substr(0, 6));
    for (int r = 0; r < replicates; ++r) {
      RunRow row = run_row(setting, r, {}, horizon, possible);
      row.values = {rates[s]};
      double t = 0;
      for (int k = 1; k <= possible; ++k) {
        const auto own = static_cast<std::uint32_t>(k % 2 == 0 ? 0 : setting + 1);
        t += -std::log(uniform({row.seed, Stream::evaluation, k, own, 0})) / rates[s];
        if (t <= horizon) row.completion.push_back(t);
      }
      row.copies = static_cast<int>(row.completion.size());
      table.rows.push_back(row);
    }
  }
  return table;
}

/// The same, with a run that diverged.
inline StudyTable with_diverged(StudyTable table) {
  RunRow row = run_row(0, 1000000, {}, 1);
  row.status = RunStatus::diverged;
  row.values = table.rows.front().values;
  row.note = "step 40, module 3, face_drag";
  table.rows.push_back(row);
  return table;
}

}  // namespace lilytank::sample
