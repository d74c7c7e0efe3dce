// What one number says about a setting's runs.
#include <cassert>

#include "lilytank/study.hpp"
#include "study/study_rows.hpp"
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

}  // namespace

bool is_metric(const std::string& name) {
  return name == "copies" || name == "full_yield" || name == "assembly_rate" || copy_of(name) > 0;
}

int copies_needed(const std::string& metric) {
  return metric == "full_yield" ? 1 : copy_of(metric);
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
  if (name == "copies") return copies_of(finished);
  if (name == "full_yield") return full_yield_of(finished);
  if (name == "assembly_rate") return assembly_rate_of(finished);
  return restricted_mean(kaplan_meier(durations_to(finished, copy_of(name))), duration);
}

}  // namespace lilytank
