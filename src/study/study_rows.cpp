#include "study/study_rows.hpp"

#include <algorithm>

namespace lilytank {

std::vector<std::vector<const RunRow*>> finished_runs(const StudyTable& table) {
  std::size_t settings = table.labels.size();
  for (const RunRow& row : table.rows) {
    settings = std::max(settings, static_cast<std::size_t>(row.setting) + 1);
  }
  std::vector<std::vector<const RunRow*>> runs(settings);
  for (const RunRow& row : table.rows) {
    if (row.status == RunStatus::ok) runs[static_cast<std::size_t>(row.setting)].push_back(&row);
  }
  for (auto& of_setting : runs) {
    std::sort(of_setting.begin(), of_setting.end(), [](const RunRow* a, const RunRow* b) {
      return a->replicate != b->replicate ? a->replicate < b->replicate : a->id < b->id;
    });
  }
  return runs;
}

int reached_copies(const RunRow& row) {
  return std::min(static_cast<int>(row.completion.size()), row.possible);
}

bool reached_all(const RunRow& row) {
  return row.possible > 0 && reached_copies(row) == row.possible;
}

double followed_until(const RunRow& row, double horizon) {
  return reached_all(row) ? horizon : std::min(row.duration, horizon);
}

double watched_by_all(const std::vector<std::vector<const RunRow*>>& runs, double horizon) {
  double all = horizon;
  for (const auto& of_setting : runs) {
    double longest = 0;
    for (const RunRow* row : of_setting) longest = std::max(longest, followed_until(*row, horizon));
    if (!of_setting.empty()) all = std::min(all, longest);
  }
  return all;
}

std::vector<Duration> durations_to(const std::vector<const RunRow*>& runs, int k) {
  std::vector<Duration> durations;
  for (const RunRow* row : runs) {
    if (row->possible < k) continue;
    const bool observed = reached_copies(*row) >= k;
    durations.push_back({observed ? row->completion[k - 1] : row->duration, observed});
  }
  return durations;
}

Estimate copies_of(const std::vector<const RunRow*>& runs) {
  std::vector<double> copies;
  int possible = 0;
  for (const RunRow* row : runs) {
    copies.push_back(row->copies), possible = std::max(possible, row->possible);
  }
  return bounded_mean_interval(copies, 0, possible);
}

Estimate full_yield_of(const std::vector<const RunRow*>& runs) {
  std::int64_t full = 0, judged = 0;
  for (const RunRow* row : runs) full += reached_all(*row), judged += row->possible > 0;
  return wilson(full, judged);
}

Estimate assembly_rate_of(const std::vector<const RunRow*>& runs) {
  std::int64_t copies = 0;
  double exposure = 0;
  for (const RunRow* row : runs) {
    copies += reached_copies(*row);
    exposure += reached_all(*row) ? row->completion[static_cast<std::size_t>(row->possible - 1)]
                                  : row->duration;
  }
  return poisson_rate(copies, exposure);
}

}  // namespace lilytank
