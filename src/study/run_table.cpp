#include "study/run_table.hpp"

#include <algorithm>

namespace lilytank {

RunTable::RunTable(const StudyPlan& plan) : plan_(&plan), rows_(plan.settings.size()) {}

void RunTable::add(RunRow row) {
  auto& rows = rows_[static_cast<std::size_t>(row.setting)];
  const auto at = static_cast<std::size_t>(row.replicate);
  if (rows.size() <= at) rows.resize(at + 1);
  if (!rows[at]) rows[at] = std::make_unique<RunRow>(std::move(row));
}

RequiredRuns RunTable::required(int setting) const {
  if (!plan_->stop) return {plan_->replicates, true};
  std::vector<const RunRow*> rows;
  for (const auto& row : rows_[static_cast<std::size_t>(setting)]) rows.push_back(row.get());
  return required_replicates(*plan_, setting, rows);
}

std::vector<RunPlace> RunTable::missing() const {
  std::vector<RunPlace> places;
  for (std::size_t s = 0; s < rows_.size(); ++s) {
    const auto n = static_cast<std::size_t>(required(static_cast<int>(s)).replicates);
    for (std::size_t r = 0; r < n; ++r) {
      const bool there = r < rows_[s].size() && rows_[s][r];
      if (!there) places.push_back({static_cast<int>(s), static_cast<int>(r)});
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const RunPlace& a, const RunPlace& b) { return a.replicate < b.replicate; });
  return places;
}

bool RunTable::complete() const {
  for (std::size_t s = 0; s < rows_.size(); ++s) {
    if (!required(static_cast<int>(s)).decided) return false;
  }
  return missing().empty();
}

std::vector<const RunRow*> RunTable::required_rows() const {
  std::vector<const RunRow*> out;
  for (std::size_t s = 0; s < rows_.size(); ++s) {
    const auto n = static_cast<std::size_t>(required(static_cast<int>(s)).replicates);
    for (std::size_t r = 0; r < std::min(n, rows_[s].size()); ++r) {
      if (rows_[s][r]) out.push_back(rows_[s][r].get());
    }
  }
  return out;
}

int RunTable::failed() const {
  const auto rows = required_rows();
  return static_cast<int>(std::count_if(rows.begin(), rows.end(), [](const RunRow* row) {
    return row->status == RunStatus::diverged;
  }));
}

}  // namespace lilytank
