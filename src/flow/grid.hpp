// The grid of a flow estimate, and what both estimators need of it.
#pragma once
#include <span>

#include "lilytank/flow_estimate.hpp"

namespace lilytank {

/// Cells x cells squares over [-extent, extent]^2.
struct FlowGrid {
  int cells = 50;
  double extent = 0.30;
  double width() const { return 2 * extent / cells; }
  int size() const { return cells * cells; }
  double centre(int i) const { return (i + 0.5) * width() - extent; }
  /// The cell that holds a point, or -1 outside the grid.
  int cell_at(double x, double y) const;
};

/// An estimate without cells' values. Throws InputError on unusable options, or if no recording is
/// of balls.
FlowEstimate empty_estimate(std::span<const Recording> recordings, const BallPhysics& ball,
                            const FlowOptions& options, const char* name);

/// Gives the cells that are not measured their values, as FlowField does. Throws InputError if no
/// cell is measured.
void fill_cells(FlowEstimate& estimate);

}  // namespace lilytank
