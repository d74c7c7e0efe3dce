// The water's velocity: mean and deviation on a grid over the tank [paper, section 3.2, Eq. 4].
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "lilytank/error.hpp"
#include "lilytank/math.hpp"

namespace lilytank {

/// Velocity statistics of one cell, m/s, before K_v.
struct FlowSample {
  /// Mean mu and standard deviation sigma >= 0 over time, per axis. The axes are taken as
  /// independent [paper, Eq. 4].
  double mu_x = 0, mu_y = 0, sigma_x = 0, sigma_y = 0;
};

/// A cell's corner values for bilinear lookup, in FlowSample's order, float32: from its own centre
/// to those at +x and +y, the field is v[0] + tx v[1] + ty v[2] + tx ty v[3], tx and ty in 0..1.
struct alignas(64) FlowRow {
  float v[4][4] = {};
};

/// How values between cell centres are read: bilinear from the four nearest, or those of the
/// nearest cell, as in the paper.
enum class Interpolation { bilinear, nearest };

/// Mean and deviation of the water velocity on cells x cells squares over [-extent, extent]^2.
/// Cell (ix, iy) has its centre at ((ix + 1/2) h - extent, (iy + 1/2) h - extent), h = 2 extent /
/// cells; cells are stored row by row, iy * cells + ix. Constant once made.
class FlowField {
 public:
  /// No field: at() must not be called.
  FlowField() = default;
  /// Takes `cells` * `cells` samples; `measured[i]` = false marks a cell without data, which is
  /// then filled from its neighbours (the mean of its neighbours, solved for all such cells at
  /// once). Throws InputError on a size that does not fit, on numbers that are not finite, on a
  /// negative sigma, or if no cell is measured.
  FlowField(int cells, double extent, std::vector<FlowSample> samples, std::vector<bool> measured,
            Interpolation interpolation);

  /// Mean and deviation at a point (m). Beyond the outermost cell centres the edge is held.
  FlowSample at(double x, double y) const;

  /// Cells along one side of the grid.
  int cells() const { return cells_; }
  /// Half of the grid's side, m.
  double extent() const { return extent_; }
  Interpolation interpolation() const { return interpolation_; }
  /// [cells * cells] with filled cells.
  const std::vector<FlowSample>& samples() const { return samples_; }
  /// Whether cell i came from data (true) or was filled (false).
  const std::vector<bool>& measured() const { return measured_; }
  /// Every cell's row, as the cells are stored: what the drag kernel reads. Those of the last row
  /// and column of cells stay empty.
  const std::vector<FlowRow>& rows() const { return rows_; }

 private:
  void fill_rows();

  int cells_ = 0;
  double extent_ = 0;
  Interpolation interpolation_ = Interpolation::bilinear;
  std::vector<FlowSample> samples_;
  std::vector<bool> measured_;
  std::vector<FlowRow> rows_;
};

/// The same field with mean and deviation multiplied by a factor >= 0.
FlowField scaled(const FlowField& field, double factor);

/// Settings of the built-in flow, an analytic form fitted to the published figures of the paper's
/// tank: no measured data.
struct AnalyticTank {
  double radius = 0.30;    ///< m
  double pump_power = 69;  ///< percent of a pump's full flow (9 l/min)
  /// Height of the water below the tank's upper border, m, negative. Lower water has a stronger
  /// surface flow.
  double water_level = -0.08;
  int inlets = 7;  ///< inlets around the wall, evenly spaced
  /// Angle of each inlet from the radius, rad (15 degrees).
  double inlet_angle = 0.2617993877991494;
  int cells = 50;  ///< cells along one side of the field's grid
  /// Surface flow relative to that at 69 % and -8 cm: proportional to pump power, and 15 % more
  /// for each centimetre that the water is lower; 0 where the level is within 1.3 cm of the
  /// tank's upper border.
  double strength() const;
};

/// The built-in flow: a swirl of 0.23 m/s at its peak 13 cm from the centre, an inflow of a third
/// of that, a stream from each inlet, and gusts of 0.14 .. 0.19 m/s per axis, for a radius of 0.3 m
/// and strength() = 1. The inflow grows with the square of strength(), the rest linearly [trends of
/// the paper's Fig. 4]. Other radii scale lengths.
FlowField analytic_tank(const AnalyticTank& tank, Interpolation interpolation);

/// Reads `ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,measured`, one row a cell,
/// in any order; `measured` = 0 marks cells to fill. Throws InputError with file, line and column;
/// so too where a velocity is beyond 5 m/s, or where the grid's extent is not that of a tank of
/// `tank_radius` (0: not known) within a factor of 5: then units are other ones than named.
FlowField read_flow_csv(const std::string& file, Interpolation interpolation,
                        double tank_radius = 0);

}  // namespace lilytank
