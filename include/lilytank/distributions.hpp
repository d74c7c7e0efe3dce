// How velocities, places and neighbours are distributed in smoothed tracks. Only frames in which a
// body was seen count.
#pragma once
#include <cstdint>
#include <vector>

#include "lilytank/metrics.hpp"

namespace lilytank {

/// Bins of equal width over low .. high; the last one holds `high`.
struct Bins {
  double low = 0, high = 1;  ///< in the unit of the binned quantity
  int count = 50;
  /// Width of a bin.
  double width() const { return (high - low) / count; }
  /// Centre of a bin, 0 <= bin < count.
  double middle(int bin) const { return low + (bin + 0.5) * width(); }
  /// -1 beyond the ends.
  int of(double value) const;
};

/// Scalars of a smoothed track that have a distribution. Outward and around refer to the tank's
/// centre.
enum class Quantity : std::uint8_t {
  speed,            ///< m/s
  velocity_x,       ///< m/s
  velocity_y,       ///< m/s
  velocity_out,     ///< away from the tank's centre, m/s
  velocity_around,  ///< about the tank's centre, counter-clockwise, m/s
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
/// Pairs at a distance (m), relative to pairs of the same bodies at different times, which are
/// independent of each other: 1 without correlation, whatever the tank's shape and the uneven
/// density. Uses ten frames a second, as more add little information; so do the next two.
BodySums pair_correlation(const SmoothRecording& recording, const Bins& bins);
/// Probability density (1/m) of the distance to the nearest other body seen in the same frame.
BodySums nearest_neighbours(const SmoothRecording& recording, const Bins& bins);

/// Mean distance to the nearest other body (m), one bin.
BodySums nearest_distance(const SmoothRecording& recording);

/// When two bodies touch.
struct ContactRule {
  double size = 0.035;      ///< side of squares or diameter of discs, m
  bool squares = true;      ///< else discs; squares need headings
  double touching = 0.001;  ///< gap at which a contact begins, m
  double apart = 0.002;     ///< m, gap above which it ends
};
/// Contacts between bodies of a recording.
struct Contacts {
  /// Duration of every contact that was seen to begin; censored where a body is lost or the
  /// recording ends.
  std::vector<Duration> durations;
  BodySums begun;     ///< contacts started by a body, a second (one bin): a contact counts for both
  BodySums touching;  ///< fraction of the time in which a body touches at least one other (one bin)
};
/// The gap between two squares is the largest one along the axes of either.
Contacts find_contacts(const SmoothRecording& recording, const ContactRule& rule);

/// Mean velocity by place: cells as in FlowField.
struct VelocityMap {
  int cells = 0;                      ///< cells along one side
  double extent = 0;                  ///< half of the map's side, m
  std::vector<double> vx, vy;         ///< m/s, NaN: no data
  std::vector<double> se_x, se_y;     ///< standard error over bodies; NaN with fewer than two there
  std::vector<std::int64_t> samples;  ///< frames
  std::vector<int> bodies;            ///< number of bodies that passed the cell
};
/// Averages the smoothed velocities of all recordings over cells x cells squares on [-extent,
/// extent]^2 (m). Frames count once per body; standard errors take bodies and assemblies as
/// independent.
VelocityMap velocity_map(const std::vector<SmoothRecording>& recordings, int cells, double extent);

}  // namespace lilytank
