#include "lilytank/study_summary.hpp"

#include <algorithm>
#include <cmath>

#include "study/study_rows.hpp"

namespace lilytank {
namespace {

constexpr int kYieldTimes = 240;  // intervals of a yield curve
constexpr std::uint64_t kBootstrapSeed =
    1;  // resampling is part of the statistic, not of the study

// All of few copies; of many, 1, 2, 5, 10, ... and the last.
std::vector<int> copies_to_tell(int possible) {
  constexpr int few = 8;
  std::vector<int> copies;
  if (possible <= few) {
    for (int k = 1; k <= possible; ++k) copies.push_back(k);
    return copies;
  }
  for (int decade = 1; decade < possible; decade *= 10) {
    for (const int k : {1, 2, 5}) {
      if (k * decade < possible) copies.push_back(k * decade);
    }
    if (decade > possible / 10) break;
  }
  copies.push_back(possible);
  return copies;
}

CurveBand yield_of(const std::vector<const RunRow*>& runs, double horizon) {
  double end = horizon;
  std::vector<std::vector<double>> steps;
  for (const RunRow* row : runs) {
    end = std::min(end, followed_until(*row, horizon));
    steps.push_back(row->completion);
  }
  if (steps.empty()) return {};
  std::vector<double> times;
  for (int i = 0; i <= kYieldTimes; ++i) times.push_back(end * i / kYieldTimes);
  return yield_band(steps, times, kBootstrapSeed);
}

CopyTime copy_time(const std::vector<const RunRow*>& runs, int k, double restricted_to) {
  CopyTime time;
  time.k = k;
  const std::vector<Duration> durations = durations_to(runs, k);
  const auto reached = std::count_if(durations.begin(), durations.end(),
                                     [](const Duration& d) { return d.observed; });
  time.reached = wilson(reached, static_cast<std::int64_t>(durations.size()));
  time.survival = kaplan_meier(durations);
  time.restricted_mean = restricted_mean(time.survival, restricted_to);
  return time;
}

void count_rows(const StudyTable& table, int setting, SettingSummary& summary) {
  for (const RunRow& row : table.rows) {
    if (row.setting != setting) continue;
    if (summary.values.empty()) summary.values = row.values;
    summary.illegal += row.illegal;
    summary.runs += row.status == RunStatus::ok;
    summary.diverged += row.status == RunStatus::diverged;
  }
}

// Student's interval reaches beyond what can be built where few runs differ. (A stopping rule goes
// by the whole interval.)
Estimate within(Estimate copies, int possible) {
  if (!std::isfinite(copies.low) || !std::isfinite(copies.high)) return copies;
  copies.low = std::max(copies.low, 0.0);
  if (possible > 0) copies.high = std::max(copies.value, std::min<double>(copies.high, possible));
  return copies;
}

SettingSummary summarise_setting(const StudyTable& table, int setting,
                                 const std::vector<const RunRow*>& runs) {
  SettingSummary summary;
  const auto at = static_cast<std::size_t>(setting);
  summary.label =
      at < table.labels.size() ? table.labels[at] : "setting " + std::to_string(setting);
  count_rows(table, setting, summary);
  for (const RunRow* row : runs) summary.possible = std::max(summary.possible, row->possible);
  summary.copies = within(copies_of(runs), summary.possible);
  summary.full_yield = full_yield_of(runs);
  summary.rate = assembly_rate_of(runs);
  return summary;
}

}  // namespace

StudySummary summarise(const StudyTable& table) {
  StudySummary summary;
  summary.name = table.name;
  summary.axes = table.axes;
  const std::vector<std::vector<const RunRow*>> runs = finished_runs(table);
  summary.horizon = table.horizon;
  for (const RunRow& row : table.rows) {
    if (!(table.horizon > 0)) summary.horizon = std::max(summary.horizon, row.duration);
  }
  summary.restricted_to = watched_by_all(runs, summary.horizon);
  int possible = 0;
  for (std::size_t s = 0; s < runs.size(); ++s) {
    summary.settings.push_back(summarise_setting(table, static_cast<int>(s), runs[s]));
    possible = std::max(possible, summary.settings.back().possible);
  }
  summary.copies = copies_to_tell(possible);
  for (std::size_t s = 0; s < runs.size(); ++s) {
    SettingSummary& setting = summary.settings[s];
    setting.yield = yield_of(runs[s], summary.horizon);
    for (const int k : summary.copies) {
      if (k <= setting.possible)
        setting.times.push_back(copy_time(runs[s], k, summary.restricted_to));
    }
  }
  compare_settings(runs, summary);
  return summary;
}

}  // namespace lilytank
