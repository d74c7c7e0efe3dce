#include "flow/node_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lilytank {
namespace {

using Row = std::vector<std::pair<int, double>>;

// Adds the square of a difference, given as nodes and factors.
void add_square(const Row& row, std::vector<Eigen::Triplet<double>>& out) {
  for (const auto& [i, a] : row) {
    for (const auto& [j, b] : row) out.emplace_back(i, j, a * b);
  }
}

double cubic_spline(double t) {
  const double a = std::fabs(t);
  if (a >= 2) return 0;
  if (a >= 1) return (2 - a) * (2 - a) * (2 - a) / 6;
  return 2.0 / 3 - a * a + a * a * a / 2;
}

// Columns that are not zero everywhere.
Eigen::MatrixXd joined(const std::vector<Eigen::VectorXd>& columns) {
  std::vector<const Eigen::VectorXd*> used;
  for (const Eigen::VectorXd& column : columns) {
    if (column.maxCoeff() > 0) used.push_back(&column);
  }
  Eigen::MatrixXd out(columns.front().size(), static_cast<Eigen::Index>(used.size()));
  for (std::size_t c = 0; c < used.size(); ++c) out.col(static_cast<Eigen::Index>(c)) = *used[c];
  return out;
}

}  // namespace

NodeGrid::NodeGrid(const FlowGrid& grid, double tank_radius)
    : grid_(grid), node_(static_cast<std::size_t>(grid.size()), -1) {
  const double reach = tank_radius + grid.width();
  for (int i = 0; i < grid.size(); ++i) {
    const double cx = grid.centre(i % grid.cells), cy = grid.centre(i / grid.cells);
    if (cx * cx + cy * cy > reach * reach) continue;
    node_[i] = static_cast<int>(cell_.size());
    cell_.push_back(i);
  }
}

int NodeGrid::beside(int node, int dx, int dy) const {
  const int ix = cell(node) % grid_.cells + dx, iy = cell(node) / grid_.cells + dy;
  if (ix < 0 || iy < 0 || ix >= grid_.cells || iy >= grid_.cells) return -1;
  return node_[iy * grid_.cells + ix];
}

Stencil NodeGrid::stencil(double x, double y) const {
  const double last = grid_.cells - 1;
  const double gx = std::clamp((x + grid_.extent) / grid_.width() - 0.5, 0.0, last);
  const double gy = std::clamp((y + grid_.extent) / grid_.width() - 0.5, 0.0, last);
  const int ix = std::min(static_cast<int>(gx), grid_.cells - 2);
  const int iy = std::min(static_cast<int>(gy), grid_.cells - 2);
  const double tx = gx - ix, ty = gy - iy;
  const std::array<double, 4> weight{(1 - tx) * (1 - ty), tx * (1 - ty), (1 - tx) * ty, tx * ty};
  Stencil s{};
  double sum = 0;
  int any = -1;
  for (int k = 0; k < 4; ++k) {
    s.node[k] = node_[(iy + k / 2) * grid_.cells + ix + k % 2];
    s.weight[k] = s.node[k] < 0 ? 0 : weight[k];
    sum += s.weight[k];
    if (s.node[k] >= 0) any = s.node[k];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (s.node[i] < 0) s.node[i] = std::max(any, 0);
    s.weight[i] = sum > 0 ? s.weight[i] / sum : 0.25;
  }
  return s;
}

Eigen::SparseMatrix<double> NodeGrid::roughness() const {
  std::vector<Eigen::Triplet<double>> entries;
  const double root = std::sqrt(2.0);
  for (int i = 0; i < size(); ++i) {
    const int left = beside(i, -1, 0), right = beside(i, 1, 0);
    const int below = beside(i, 0, -1), above = beside(i, 0, 1), corner = beside(i, 1, 1);
    if (left >= 0 && right >= 0) add_square({{left, 1}, {i, -2}, {right, 1}}, entries);
    if (below >= 0 && above >= 0) add_square({{below, 1}, {i, -2}, {above, 1}}, entries);
    if (right >= 0 && above >= 0 && corner >= 0) {
      add_square({{i, root}, {right, -root}, {above, -root}, {corner, root}}, entries);
    }
  }
  Eigen::SparseMatrix<double> k(size(), size());
  k.setFromTriplets(entries.begin(), entries.end());
  return k;
}

Eigen::MatrixXd NodeGrid::splines(double spacing) const {
  const int reach = static_cast<int>(std::ceil(grid_.extent / spacing)) + 2;
  std::vector<Eigen::VectorXd> columns;
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      Eigen::VectorXd column(size());
      for (int n = 0; n < size(); ++n) {
        column[n] = cubic_spline(x(n) / spacing - i) * cubic_spline(y(n) / spacing - j);
      }
      columns.push_back(std::move(column));
    }
  }
  return joined(columns);
}

Eigen::MatrixXd NodeGrid::radial_splines(double spacing) const {
  const int reach = static_cast<int>(std::ceil(grid_.extent / spacing)) + 2;
  std::vector<Eigen::VectorXd> columns;
  for (int i = 0; i <= reach; ++i) {
    Eigen::VectorXd column(size());
    for (int n = 0; n < size(); ++n) {
      const double r = std::sqrt(x(n) * x(n) + y(n) * y(n)) / spacing;
      // Those on both sides of the centre go together, so that the sum is smooth there.
      column[n] = cubic_spline(r - i) + (i > 0 ? cubic_spline(r + i) : 0);
    }
    columns.push_back(std::move(column));
  }
  return joined(columns);
}

}  // namespace lilytank
