// The water's velocity from the tracks of balls that float in it [paper, section 3.2].
//
// Two estimators of the same two things, the mean mu and the standard deviation sigma of Eq. 4 in
// each cell:
//
// `estimate_paper` is Eq. 3: the water's velocity in every frame from a ball's velocity and
// acceleration, then mean and standard deviation of these over the frames that fall into a cell.
//
// `estimate_smooth` finds the flow for which the balls' equation of motion (drag under gusts,
// random force, damping) agrees with the tracks on average; the data determine the smoothness of
// the fields. It separates the tracking noise, the balls' own random force and the water's gusts.
//
// docs/flow.md derives both and lists their measured errors.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lilytank/flow_field.hpp"
#include "lilytank/model.hpp"
#include "lilytank/normality.hpp"
#include "lilytank/recording.hpp"
#include "lilytank/scenario.hpp"
#include "lilytank/smoothing.hpp"

namespace lilytank {

/// What is known of the balls and the tank beforehand.
struct BallPhysics {
  double mass = 0.0131;            ///< mass of a ball, kg
  double radius = 0.015;           ///< radius of a ball, m
  double drag_area = 7e-4;         ///< m^2 [paper, section 3.2]
  double drag_coefficient = 0.47;  ///< C of Eq. 2, of a sphere [paper, section 3.2]
  double rho = 1000;               ///< density of the water, kg/m^3
  double draws = 10;               ///< independent gusts that a ball averages over (model)
  double gust_interval = kTick;    ///< for which a gust and a random force are held, s
  double damping = 0.4034671;      ///< 1/s, -ln(1 - D_linear)
  double tank_radius = 0.30;       ///< inner radius of the tank, m
  /// 1/m: acceleration is this times |w| w, w the water's velocity relative to the ball.
  double drag_rate() const { return 0.5 * rho * drag_area * drag_coefficient / mass; }
};
/// From a model: its balls and tank; coefficient, draws and damping of its forces, where they are
/// on. A coefficient that is the default of `ball_drag`, which is fitted to another purpose
/// [Table 1], is left at the sphere's.
BallPhysics ball_physics(const Model& model);
/// The same of a scenario: a coefficient that its files set is taken, whatever it is.
BallPhysics ball_physics(const Scenario& scenario);

/// Settings of both estimators.
struct FlowOptions {
  int cells = 50;  ///< along a side of the grid over the tank
  SmoothingOptions smoothing{SmoothingMethod::polynomial, 0.3, 3};  ///< of Eq. 3
  int least_samples = 20;  ///< frames; a cell with fewer is filled
  /// Level of the normality tests in the cells, and rate of false discoveries over all cells.
  double significance = 0.05;
  int draws = 0;       ///< number of draws from the posterior (smooth only)
  int components = 0;  ///< number of its principal components (smooth only)
};

/// Of the tank's radius: where modules are.
inline constexpr double kVisitedRadius = 0.96;

/// One field's difference from another, cell by cell, m/s.
using FlowDifference = std::vector<FlowSample>;

/// One cell of an estimate. Errors are standard errors.
struct FlowCell {
  FlowSample flow;        ///< m/s; where not measured, filled from the cells around
  FlowSample error;       ///< m/s; NaN where unknown
  int samples = 0;        ///< frames (paper) or momentum balances (smooth) in this cell
  int stays = 0;          ///< visits of balls that count as independent (paper only)
  bool measured = false;  ///< false: without enough data, filled
  /// Normality of all frames as if they were independent, one reading of Fig. 3 (paper only).
  NormalityTest all_x, all_y;
  NormalityTest normal_x, normal_y;  ///< normality of one sample per stay (paper only)
};

/// What moves the balls besides the mean flow, each with its standard error.
struct NoiseBudget {
  /// Standard deviation of a measured position per axis, m.
  double tracking = 0, tracking_error = 0;
  /// Standard deviation sigma_stoch of the random force, N, one draw per gust interval.
  double stochastic = 0, stochastic_error = 0;
  double gusts = 0, gusts_error = 0;  ///< mean standard deviation over the measured cells, m/s
};

/// An estimated field with its errors. Cells lie as in FlowField.
struct FlowEstimate {
  std::string name;  ///< "paper" or "smooth"
  int cells = 0;
  double extent = 0;                 ///< the grid covers [-extent, extent]^2, m
  std::vector<FlowCell> cell;        ///< iy * cells + ix, as in FlowField
  std::optional<NoiseBudget> noise;  ///< smooth only
  /// Draws from the posterior of mean and deviation together, less the estimate: fields that the
  /// data and their smoothness allow as well. Zero outside the tank.
  std::vector<FlowDifference> draws;
  /// Principal components of the posterior of the mean, those of most variance within
  /// kVisitedRadius, each times its standard deviation (Karhunen-Loeve).
  std::vector<FlowDifference> components;
  double thinning = 0;    ///< s between samples of a track that count as independent (paper only)
  double smoothness = 0;  ///< effective number of free values of the mean field (smooth only)
  std::int64_t samples = 0, dropped = 0;  ///< used, and excluded: a contact or the wall
  std::string filter;                     ///< what was done to the tracks, one sentence
  /// Centre of cell i, m.
  double x(int i) const { return (i % cells + 0.5) * 2 * extent / cells - extent; }
  /// Centre of cell i, m.
  double y(int i) const { return (i / cells + 0.5) * 2 * extent / cells - extent; }
  /// Number of measured cells.
  int measured() const;
};

/// Eq. 3 on smoothed tracks. `recordings` are of balls; others are ignored. Throws InputError if
/// there are none, or if no cell has enough samples.
FlowEstimate estimate_paper(std::span<const Recording> recordings, const BallPhysics& ball,
                            const FlowOptions& options = {});
/// The momentum balance with smooth fields. Throws InputError as estimate_paper, and if the tracks
/// are too short for it.
FlowEstimate estimate_smooth(std::span<const Recording> recordings, const BallPhysics& ball,
                             const FlowOptions& options = {});

/// The grid that a run reads (read_flow_csv), filled cells with measured = 0.
std::string flow_csv(const FlowEstimate& estimate);
/// One row a cell: everything in FlowCell.
std::string flow_cells_csv(const FlowEstimate& estimate);
/// The field of an estimate, as a run would use it.
FlowField field_of(const FlowEstimate& estimate, Interpolation interpolation);

/// A grid whose flow is known: rows `ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps`
/// with or without `measured`; cells that are not in it (or not measured) are NaN.
struct FlowTruth {
  int cells = 0;
  std::vector<FlowSample> sample;  ///< [cells * cells] as in FlowField; NaN: not known
};
/// Throws InputError with file, line and column, and if a row is not of a `cells` x `cells` grid.
FlowTruth read_flow_truth(const std::string& file, int cells);

/// Differences of an estimate from a truth, over cells that are in both.
struct FlowError {
  int cells = 0;
  double mean_rms = 0;        ///< root mean square error of mu per axis, m/s
  double mean_radial = 0;     ///< average of the difference outwards, m/s
  double mean_around = 0;     ///< average of the difference counter-clockwise, m/s
  double deviation_rms = 0;   ///< root mean square error of sigma per axis, m/s
  double deviation_bias = 0;  ///< mean error of sigma, m/s
  /// Fraction of differences of mu within 1.96 standard errors; 0.95 is nominal.
  double mean_coverage = 0;
  double deviation_coverage = 0;  ///< fraction of differences of sigma within 1.96 standard errors
};
/// Over the measured cells, or over all.
FlowError compare_flow(const FlowEstimate& estimate, const FlowTruth& truth, bool measured_only);
/// The differences, one row a cell.
std::string flow_errors_csv(const FlowEstimate& estimate, const FlowTruth& truth);

}  // namespace lilytank
