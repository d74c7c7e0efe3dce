// Whether recordings are long enough for the questions that are put to them, before anything is
// simulated: how well the balls measured the flow where the Lilies went, and how long these were
// seen.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lilytank/flow_estimate.hpp"
#include "lilytank/recording.hpp"

namespace lilytank {

/// What recordings must meet for error rates that are known.
enum class Requirement : std::uint8_t { lily_time, measured_cells, mean_flow, gusts };
inline constexpr std::array kRequirements{Requirement::lily_time, Requirement::measured_cells,
                                          Requirement::mean_flow, Requirement::gusts};
/// "time of the Lilies", "measured cells", "mean flow", "gusts".
std::string name_of(Requirement requirement);

/// A requirement that recordings do not meet.
struct Shortfall {
  Requirement requirement = Requirement::lily_time;
  std::string what;    ///< what is measured, its value, and the bound that it does not meet
  double minutes = 0;  ///< to record in addition, with as many bodies
  BodyKind body = BodyKind::ball;
  int count = 0;               ///< of these bodies
  std::string bodies() const;  ///< "24 balls"
};
/// What to record in addition to meet all of them: "8 min more of 24 balls and 2 min more of 15
/// Lilies".
std::string to_record(const std::vector<Shortfall>& shortfalls);

/// What recordings cover. Times are sums over bodies of the time for which each was seen.
struct Coverage {
  double ball_minutes = 0;
  double lily_minutes = 0;  ///< of recordings that are fitted
  /// Share of the Lilies' time that they spent in cells of the flow map that balls measured.
  double measured = 1;
  /// Root mean square, over the Lilies' time, of the standard error per axis of the mean flow and
  /// of the mean flow itself, m/s. NaN if the flow is not estimated from balls.
  double flow_error = 0, flow_speed = 0;
  /// Standard error of the gusts' mean standard deviation, relative to it; NaN where unknown.
  double gust_error = 0;
  std::vector<Shortfall> flow;    ///< of the flow map: without it no parameter and no force
  std::vector<Shortfall> lilies;  ///< of a diagnosis, beside the flow map
};

/// Least share of the Lilies' time in measured cells; largest standard errors of the mean flow
/// relative to its speed and of the gusts' standard deviation relative to it; least time of Lilies
/// for a diagnosis, min. docs/flow.md shows the errors of flow maps on either side.
inline constexpr double kLeastMeasured = 0.9, kLargestFlowError = 0.1, kLargestGustError = 0.12,
                        kLeastLilyMinutes = 15;

/// `flow`: estimated from `balls`; null if the scenario's flow is used. `lilies`: those that are
/// fitted; of other bodies nothing is counted.
Coverage coverage_of(const FlowEstimate* flow, std::span<const Recording> balls,
                     std::span<const Recording> lilies);
/// What recordings fall short of for a diagnosis: of the flow map first, which everything rests on.
std::vector<Shortfall> shortfalls_of(const FlowEstimate* flow, std::span<const Recording> balls,
                                     std::span<const Recording> lilies);

}  // namespace lilytank
