#include "lilytank/motion_summary.hpp"
#include "statistics/undefined.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lilytank/math.hpp"
#include "tracks/summary_parts.hpp"

namespace lilytank {
namespace {

constexpr double kEq9Steps = 2400;  // N_s of the paper

SummaryValues values_of(const std::vector<Recording>& recordings, const MotionSummary& summary) {
  SummaryParts parts;
  add_motion_parts(summary, parts);
  add_balance_parts(summary, parts);
  SummaryValues values;
  for (const auto& part : parts) {
    for (const Recording& recording : recordings) {
      part->add(recording);
      for (const Track& track : recording.tracks) part->add(track);
    }
    part->report(values);
  }
  return values;
}

// Adds one track's squared displacements at every lag; those that are no whole number of frames
// are rounded by themselves, so that roundings do not add up.
void add_displacements(const Track& track, double rate, const Eq9& rule,
                       std::vector<MeanSum>& sums) {
  const int origin_step = frames_of(rule.origins, rate);
  const auto n = static_cast<int>(track.x.size());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const int lag = frames_of(static_cast<double>(k + 1) * rule.lag, rate);
    MeanSum sum = sums[k];  // a copy, as memory would be slower
    for (int i = 0; i + lag < n; i += origin_step) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(i + lag);
      const double dx = track.x[b] - track.x[a], dy = track.y[b] - track.y[a];
      sum.add(dx * dx + dy * dy);
      if (rule.first_origin) break;
    }
    sums[k] = sum;
  }
}

}  // namespace

int frames_of(double seconds, double rate) {
  return std::max(1, static_cast<int>(std::lround(seconds * rate)));
}

double log_of(double value) {
  return log_portable(std::max(value, 1e-12));
}

std::vector<SummaryEntry> summary_entries(const MotionSummary& summary) {
  std::vector<SummaryEntry> entries;
  for (const SummaryValue& v : values_of({}, summary)) entries.push_back({v.group, v.name});
  return entries;
}

std::vector<double> summarise(const std::vector<Recording>& recordings,
                              const MotionSummary& summary) {
  std::vector<double> values;
  for (const SummaryValue& v : values_of(recordings, summary)) {
    values.push_back(std::isfinite(v.value) ? v.value : 0);
  }
  return values;
}

std::vector<double> eq9_curve(const std::vector<Recording>& recordings, const Eq9& rule) {
  std::vector<MeanSum> sums(static_cast<std::size_t>(std::lround(rule.seconds / rule.lag)));
  for (const Recording& recording : recordings) {
    for (const Track& track : recording.tracks) {
      // Of the first origin, only where the body was there from the begin.
      if (rule.first_origin && track.first > 0) continue;
      add_displacements(track, recording.rate, rule, sums);
    }
  }
  std::vector<double> out;
  for (const MeanSum& sum : sums) out.push_back(sum.weight > 0 ? sum.mean() : kUndefined);
  return out;
}

double eq9(const std::vector<double>& first, const std::vector<double>& second) {
  MeanSum sum;
  const std::size_t n = std::min(first.size(), second.size());
  for (std::size_t i = 0; i < n; ++i) sum.add(std::fabs(first[i] - second[i]));
  return sum.weight > 0 ? kEq9Steps * sum.mean() : std::numeric_limits<double>::infinity();
}

}  // namespace lilytank
