#include "lilytank/flow_field.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace lilytank {
namespace {

// Gives the cells without data the mean of their neighbours (the discrete Laplace equation, solved
// directly), so that a body there meets water like that around it, not still water.
void fill(int cells, std::vector<FlowSample>& samples, const std::vector<bool>& measured) {
  std::vector<int> row(samples.size(), -1);
  int unknowns = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!measured[i]) row[i] = unknowns++;
  }
  if (unknowns == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(unknowns, 4);
  for (int iy = 0; iy < cells; ++iy) {
    for (int ix = 0; ix < cells; ++ix) {
      const int r = row[iy * cells + ix];
      if (r < 0) continue;
      int neighbours = 0;
      const auto couple = [&](int jx, int jy) {
        if (jx < 0 || jy < 0 || jx >= cells || jy >= cells) return;
        ++neighbours;
        const int j = jy * cells + jx;
        const FlowSample& f = samples[j];
        if (row[j] >= 0)
          entries.emplace_back(r, row[j], -1.0);
        else
          right.row(r) += Eigen::RowVector4d(f.mu_x, f.mu_y, f.sigma_x, f.sigma_y);
      };
      couple(ix - 1, iy), couple(ix + 1, iy), couple(ix, iy - 1), couple(ix, iy + 1);
      entries.emplace_back(r, r, neighbours);
    }
  }
  Eigen::SparseMatrix<double> laplace(unknowns, unknowns);
  laplace.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(laplace);
  const Eigen::MatrixXd filled = solver.solve(right);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (row[i] < 0) continue;
    const auto f = filled.row(row[i]);
    samples[i] = {f[0], f[1], std::max(0.0, f[2]), std::max(0.0, f[3])};
  }
}

bool usable(const FlowSample& f) {
  return std::isfinite(f.mu_x) && std::isfinite(f.mu_y) && std::isfinite(f.sigma_x) &&
         std::isfinite(f.sigma_y) && f.sigma_x >= 0 && f.sigma_y >= 0;
}

}  // namespace

FlowField::FlowField(int cells, double extent, std::vector<FlowSample> samples,
                     std::vector<bool> measured, Interpolation interpolation)
    : cells_(cells),
      extent_(extent),
      interpolation_(interpolation),
      samples_(std::move(samples)),
      measured_(std::move(measured)) {
  const auto size = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
  if (cells < 2 || !(extent > 0) || samples_.size() != size || measured_.size() != size)
    throw InputError("a flow field needs cells x cells samples, at least 2 x 2");
  if (std::none_of(measured_.begin(), measured_.end(), [](bool m) { return m; }))
    throw InputError("the flow field has no measured cell");
  for (std::size_t i = 0; i < size; ++i) {
    if (measured_[i] && !usable(samples_[i]))
      throw InputError("flow cell " + std::to_string(i) + " is not finite or has a negative sigma");
  }
  fill(cells_, samples_, measured_);
  fill_rows();
}

void FlowField::fill_rows() {
  rows_.resize(samples_.size());
  const auto numbers = [&](std::size_t i) {
    const FlowSample& f = samples_[i];
    return Eigen::Array4d(f.mu_x, f.mu_y, f.sigma_x, f.sigma_y);
  };
  for (int iy = 0; iy + 1 < cells_; ++iy) {
    for (int ix = 0; ix + 1 < cells_; ++ix) {
      const std::size_t i = static_cast<std::size_t>(iy) * cells_ + ix;
      const Eigen::Array4d a = numbers(i), b = numbers(i + 1), c = numbers(i + cells_),
                           d = numbers(i + cells_ + 1);
      const Eigen::Array4d terms[4] = {a, b - a, c - a, a - b - c + d};
      for (int k = 0; k < 4; ++k)
        Eigen::Map<Eigen::Array4f>(rows_[i].v[k]) = terms[k].cast<float>();
    }
  }
}

FlowSample FlowField::at(double x, double y) const {
  const double per_metre = cells_ / (2 * extent_), last = cells_ - 1;
  double gx = (x + extent_) * per_metre - 0.5, gy = (y + extent_) * per_metre - 0.5;
  if (interpolation_ == Interpolation::nearest)
    gx = std::floor(gx + 0.5), gy = std::floor(gy + 0.5);
  gx = std::clamp(gx, 0.0, last), gy = std::clamp(gy, 0.0, last);
  const int ix = std::min(static_cast<int>(gx), cells_ - 2);
  const int iy = std::min(static_cast<int>(gy), cells_ - 2);
  const double tx = gx - ix, ty = gy - iy;
  const FlowSample* f = &samples_[static_cast<std::size_t>(iy) * cells_ + ix];
  const double w00 = (1 - tx) * (1 - ty), w10 = tx * (1 - ty), w01 = (1 - tx) * ty, w11 = tx * ty;
  const FlowSample &a = f[0], &b = f[1], &c = f[cells_], &d = f[cells_ + 1];
  return {w00 * a.mu_x + w10 * b.mu_x + w01 * c.mu_x + w11 * d.mu_x,
          w00 * a.mu_y + w10 * b.mu_y + w01 * c.mu_y + w11 * d.mu_y,
          w00 * a.sigma_x + w10 * b.sigma_x + w01 * c.sigma_x + w11 * d.sigma_x,
          w00 * a.sigma_y + w10 * b.sigma_y + w01 * c.sigma_y + w11 * d.sigma_y};
}

FlowField scaled(const FlowField& field, double factor) {
  std::vector<FlowSample> samples = field.samples();
  for (FlowSample& s : samples)
    s = {factor * s.mu_x, factor * s.mu_y, factor * s.sigma_x, factor * s.sigma_y};
  return {field.cells(), field.extent(), std::move(samples), field.measured(),
          field.interpolation()};
}

}  // namespace lilytank
