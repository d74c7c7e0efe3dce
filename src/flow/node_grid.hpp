// The flow as values at cell centres with bilinear values between them, the measure of how rough
// it is, and a coarser basis for the standard deviation.
#pragma once
#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "flow/grid.hpp"

namespace lilytank {

/// Four nodes and their weights, which sum to 1.
struct Stencil {
  std::array<int, 4> node;
  std::array<double, 4> weight;
};

/// Nodes are the centres of the cells that the tank touches.
class NodeGrid {
 public:
  NodeGrid(const FlowGrid& grid, double tank_radius);
  int size() const { return static_cast<int>(cell_.size()); }
  int cell(int node) const { return cell_[node]; }
  double x(int node) const { return grid_.centre(cell(node) % grid_.cells); }
  double y(int node) const { return grid_.centre(cell(node) / grid_.cells); }
  /// The node a step away, or -1.
  int beside(int node, int dx, int dy) const;
  /// Where bilinear values at a point come from; points outside are drawn to the nearest nodes.
  Stencil stencil(double x, double y) const;
  /// Sum of squared second differences, as a quadratic form: zero for plane fields.
  Eigen::SparseMatrix<double> roughness() const;
  /// Values at the nodes of smooth functions that sum to 1: cubic B-splines of this spacing (m).
  Eigen::MatrixXd splines(double spacing) const;
  /// The same in the distance from the centre alone.
  Eigen::MatrixXd radial_splines(double spacing) const;

 private:
  FlowGrid grid_;
  std::vector<int> node_, cell_;
};

}  // namespace lilytank
