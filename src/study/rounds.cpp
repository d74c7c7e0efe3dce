#include "study/rounds.hpp"

#include <algorithm>

namespace lilytank {
namespace {

bool narrow_enough(const StoppingRule& rule, const std::vector<const RunRow*>& first,
                   double duration) {
  const Estimate estimate = metric_estimate(rule.metric, first, duration);
  return (estimate.high - estimate.low) / 2 <= rule.half_width;  // false for no number
}

}  // namespace

RequiredRuns required_replicates(const StudyPlan& plan, int setting,
                                 const std::vector<const RunRow*>& rows) {
  if (!plan.stop) return {plan.replicates, true};
  const StoppingRule& rule = *plan.stop;
  const double duration = plan.settings[static_cast<std::size_t>(setting)].duration;
  const auto missing = std::find(rows.begin(), rows.end(), nullptr);
  const auto complete = static_cast<int>(missing - rows.begin());
  for (int m = rule.min;; m = std::min(m + rule.round, rule.max)) {
    if (m >= rule.max) return {rule.max, true};
    if (complete < m) return {m, false};
    const std::vector<const RunRow*> first(rows.begin(), rows.begin() + m);
    if (narrow_enough(rule, first, duration)) return {m, true};
  }
}

}  // namespace lilytank
