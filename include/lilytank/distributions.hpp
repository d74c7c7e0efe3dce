// How velocities, places and neighbours are distributed in smoothed tracks. Only frames in which a
// body was seen count.
#pragma once
#include <cstdint>
#include <vector>

#include "lilytank/metrics.hpp"

namespace lilytank {

/// Bins of equal width over low .. high; the last one holds `high`.
struct Bins {
  double low = 0, high = 1;
  int count = 50;
  double width() const { return (high - low) / count; }
  double middle(int bin) const { return low + (bin + 0.5) * width(); }
  /// -1 beyond the ends.
  int of(double value) const;
};

enum class Quantity : std::uint8_t {
  speed,            ///< m/s
  velocity_x,       ///< m/s
  velocity_y,       ///< m/s
  velocity_out,     ///< m/s, away from the tank's centre
  velocity_around,  ///< m/s, about the tank's centre, counter-clockwise
  spin,             ///< rad/s
};

/// Probability density of a quantity (1 over its unit). Values beyond the bins count as samples.
BodySums distribution(const SmoothRecording& recording, Quantity quantity, const Bins& bins);
/// The quantity that a share of all samples does not exceed in size; 0 without samples.
double quantile_of_size(const SmoothRecording& recording, Quantity quantity, double share);
/// Mean of a quantity's `power`-th power, 1 or 2: a curve of one bin.
BodySums mean_power(const SmoothRecording& recording, Quantity quantity, int power);
/// Mean rate at which bodies go round the tank's centre: of r x v over r^2 (rad/s), one bin.
BodySums circulation(const SmoothRecording& recording);

/// Density of centres over the distance from the tank's centre, relative to an even spread over the
/// tank's circle of radius `tank_radius` (m).
BodySums radial_density(const SmoothRecording& recording, double tank_radius, const Bins& bins);
/// Pairs at a distance (m), relative to pairs of the same bodies at different times, which know
/// nothing of each other: 1 without correlation, whatever the tank's shape and the uneven density.
/// Looks at ten frames a second, as more would tell little more; so do the next two.
BodySums pair_correlation(const SmoothRecording& recording, const Bins& bins);
/// Probability density (1/m) of the distance to the nearest other body seen in the same frame.
BodySums nearest_neighbours(const SmoothRecording& recording, const Bins& bins);

/// Mean distance to the nearest other body (m), one bin.
BodySums nearest_distance(const SmoothRecording& recording);

/// When two bodies touch.
struct ContactRule {
  double size = 0.035;      ///< m, side of squares or diameter of discs
  bool squares = true;      ///< else discs; squares need headings
  double touching = 0.001;  ///< m, gap at which a contact begins
  double apart = 0.002;     ///< m, gap above which it ends
};
struct Contacts {
  /// Of all contacts that were seen to begin; not observed to the end where a body is lost or the
  /// recording ends.
  std::vector<Duration> durations;
  BodySums begun;     ///< contacts begun by a body, a second (one bin): a contact counts for both
  BodySums touching;  ///< share of the time in which a body touches at least one other (one bin)
};
/// The gap between two squares is the largest one along the axes of either.
Contacts find_contacts(const SmoothRecording& recording, const ContactRule& rule);

/// Mean velocity by place: cells as in FlowField.
struct VelocityMap {
  int cells = 0;
  double extent = 0;                  ///< m
  std::vector<double> vx, vy;         ///< m/s, NaN: no data
  std::vector<double> se_x, se_y;     ///< standard error over bodies; NaN with fewer than two there
  std::vector<std::int64_t> samples;  ///< frames
  std::vector<int> bodies;            ///< that passed
};
VelocityMap velocity_map(const std::vector<SmoothRecording>& recordings, int cells, double extent);

}  // namespace lilytank
