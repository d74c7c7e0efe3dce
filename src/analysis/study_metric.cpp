// What one number says about a setting's runs.
#include <cassert>

#include "analysis/study_rows.hpp"
#include "lilytank/study.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// k of "time_k", or 0.
int copy_of(const std::string& name) {
  constexpr std::string_view prefix = "time_";
  if (!name.starts_with(prefix) || name.size() > prefix.size() + 6) return 0;
  const std::string_view digits = std::string_view(name).substr(prefix.size());
  const bool plain = !digits.empty() && digits.front() >= '1' && digits.front() <= '9';
  const auto k = parse_whole(digits);
  return plain && k ? static_cast<int>(*k) : 0;
}

Estimate copies(const std::vector<const RunRow*>& runs) {
  std::vector<double> values;
  for (const RunRow* run : runs) values.push_back(run->copies);
  return mean_interval(values);
}

Estimate full_yield(const std::vector<const RunRow*>& runs) {
  std::int64_t full = 0;
  for (const RunRow* run : runs) full += reached_all(*run);
  return wilson(full, static_cast<std::int64_t>(runs.size()));
}

// Copies over the time in which there were modules left to build with.
Estimate assembly_rate(const std::vector<const RunRow*>& runs) {
  std::int64_t events = 0;
  double exposure = 0;
  for (const RunRow* run : runs) {
    events += reached_copies(*run);
    exposure += reached_all(*run) ? run->completion[static_cast<std::size_t>(run->possible - 1)]
                                  : run->duration;
  }
  return poisson_rate(events, exposure);
}

}  // namespace

bool is_metric(const std::string& name) {
  return name == "copies" || name == "full_yield" || name == "assembly_rate" || copy_of(name) > 0;
}

std::string metric_unit(const std::string& name) {
  if (name == "assembly_rate") return "1/s";
  return copy_of(name) > 0 ? "s" : "1";
}

Estimate metric_estimate(const std::string& name, const std::vector<const RunRow*>& runs,
                         double duration) {
  assert(is_metric(name));
  std::vector<const RunRow*> finished;
  for (const RunRow* run : runs) {
    if (run->status == RunStatus::ok) finished.push_back(run);
  }
  if (name == "copies") return copies(finished);
  if (name == "full_yield") return full_yield(finished);
  if (name == "assembly_rate") return assembly_rate(finished);
  return restricted_mean(kaplan_meier(durations_to(finished, copy_of(name))), duration);
}

}  // namespace lilytank
