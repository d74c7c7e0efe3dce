#include "scores/nuisances.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "filter/sensitivity_kernel.hpp"
#include "lilytank/study.hpp"
#include "scores/flow_uncertainty.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::size_t kMeanModes = Nuisances::kMeanModes, kGustModes = 16;
constexpr std::size_t kOfCell = 3 * kMeanModes + kGustModes;
constexpr int kDraws = 600;
constexpr int kMostCells = 50;  // a side of the grid: finer maps would need gigabytes
constexpr double kLeastVariance = 1e-4;

// Errors of a flow map, [value, draw]: of the mean, first along x, and, relative, of the gusts.
// Divided by the root of their number: a sum of squares is a variance.
struct Errors {
  Matrix mean, gusts;
};

// Centres of the cells of a square grid, row by row.
std::vector<Vec2> centres(int cells, double extent) {
  const double pitch = 2 * extent / cells;
  std::vector<Vec2> out;
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      out.emplace_back((column + 0.5) * pitch - extent, (row + 0.5) * pitch - extent);
    }
  }
  return out;
}

Errors drawn_errors(const FlowMaps& maps, const std::vector<Vec2>& places, std::uint64_t seed,
                    int threads) {
  const auto n = static_cast<Eigen::Index>(places.size());
  Errors out{Matrix(2 * n, kDraws), Matrix(n, kDraws)};
  for_each_world(kDraws, threads, [&](int d) {
    const auto drawn = perturbed_flow(maps, seed, seed, d);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vec2& at = places[static_cast<std::size_t>(i)];
      const FlowSample a = drawn->at(at.x(), at.y()), b = maps.best()->at(at.x(), at.y());
      out.mean(i, d) = a.mu_x - b.mu_x, out.mean(n + i, d) = a.mu_y - b.mu_y;
      out.gusts(i, d) = b.sigma_x > 0 ? a.sigma_x / b.sigma_x - 1 : 0;
    }
  });
  const auto centre = [](Matrix& of) {
    of.colwise() -= Vector(of.rowwise().mean());
    of /= std::sqrt(kDraws - 1.0);
  };
  centre(out.mean), centre(out.gusts);
  return out;
}

// Columns of which the sum of squares is the covariance of the mean's errors: where the posterior's
// components are known, these and draws of the other errors. Draws of the posterior itself are too
// few to find its components: fewer than it has directions.
Matrix root_of_mean(const FlowMaps& maps, const std::vector<Vec2>& places, const Errors& drawn,
                    std::uint64_t seed, int threads) {
  if (maps.components().empty()) return drawn.mean;
  const FlowField& field = *maps.best();
  const auto n = static_cast<Eigen::Index>(places.size());
  Matrix open(2 * n, static_cast<Eigen::Index>(maps.components().size()));
  for (Eigen::Index k = 0; k < open.cols(); ++k) {
    const FlowField one(field.cells(), field.extent(),
                        maps.components()[static_cast<std::size_t>(k)], field.measured(),
                        field.interpolation());
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vec2& at = places[static_cast<std::size_t>(i)];
      const FlowSample of = one.at(at.x(), at.y());
      open(i, k) = kPosteriorScale * of.mu_x, open(n + i, k) = kPosteriorScale * of.mu_y;
    }
  }
  const Matrix others = drawn_errors(FlowMaps(maps.best()), places, seed, threads).mean;
  Matrix out(2 * n, open.cols() + others.cols());
  out << open, others;
  return out;
}

// Principal components of errors, each of the size of a standard deviation, [value, component];
// those of most variance within `rows`.
Matrix components(const Matrix& errors, const std::vector<Eigen::Index>& rows, std::size_t count) {
  const Matrix within = errors(rows, Eigen::all);
  const Eigen::SelfAdjointEigenSolver<Matrix> solved(within.transpose() * within);
  const Matrix leading =
      solved.eigenvectors().rightCols(static_cast<Eigen::Index>(count)).rowwise().reverse();
  return errors * leading;
}

// The values of a grid about a cell that modules feel: the mean over 3 x 3 cells, a module's side,
// and differences across its neighbours.
class About {
 public:
  About(int cells, int x, int y) : cells_(cells), x_(x), y_(y) {}
  double mean(const Eigen::Ref<const Vector>& of) const {
    double sum = 0;
    for (int b = -1; b <= 1; ++b) {
      for (int a = -1; a <= 1; ++a) sum += of(at(a, b));
    }
    return sum / 9;
  }
  double along_x(const Eigen::Ref<const Vector>& of) const { return of(at(1, 0)) - of(at(-1, 0)); }
  double along_y(const Eigen::Ref<const Vector>& of) const { return of(at(0, 1)) - of(at(0, -1)); }

 private:
  Eigen::Index at(int a, int b) const {
    return std::clamp(y_ + b, 0, cells_ - 1) * cells_ + std::clamp(x_ + a, 0, cells_ - 1);
  }
  int cells_, x_, y_;
};

}  // namespace

const std::array<Nuisances::Parameter, Nuisances::kParameters> Nuisances::kModelParameters{
    {{"drag", 0.3},
     {"flow", 0.15},
     {"linear damping", 0.3},
     {"angular damping", 0.3},
     {"gusts", 0.2}}};

Nuisances::Nuisances(const Model& model, const FlowMaps& maps, std::uint64_t seed, int threads)
    : cells_(std::min(maps.best()->cells(), kMostCells)), extent_(maps.best()->extent()) {
  const std::vector<Vec2> places = centres(cells_, extent_);
  const Errors errors = drawn_errors(maps, places, seed, threads);
  const Eigen::Index n = errors.gusts.rows();
  std::vector<Eigen::Index> visited, both;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double radius = std::sqrt(places[static_cast<std::size_t>(i)].squaredNorm());
    if (radius <= kVisitedRadius * model.tank.radius) visited.push_back(i);
  }
  both = visited;
  for (const Eigen::Index i : visited) both.push_back(n + i);
  mean_basis_ = components(root_of_mean(maps, places, errors, seed, threads), both, kMeanModes);
  gust_basis_ = components(errors.gusts, visited, kGustModes);
  const double pitch = 2 * extent_ / cells_, gain = model.flow.K_v;
  changes_.resize(static_cast<std::size_t>(n) * kOfCell);
  for (Eigen::Index i = 0; i < n; ++i) {
    const About cell(cells_, static_cast<int>(i) % cells_, static_cast<int>(i) / cells_);
    float* of = &changes_[static_cast<std::size_t>(i) * kOfCell];
    for (std::size_t k = 0; k < kMeanModes; ++k) {
      const auto column = mean_basis_.col(static_cast<Eigen::Index>(k));
      const auto u = column.head(n), v = column.tail(n);
      of[k] = static_cast<float>(gain * cell.mean(u));
      of[kMeanModes + k] = static_cast<float>(gain * cell.mean(v));
      // Half the curl; differences are across two cells.
      of[2 * kMeanModes + k] =
          static_cast<float>(gain * (cell.along_x(v) - cell.along_y(u)) / (4 * pitch));
    }
    for (std::size_t k = 0; k < kGustModes; ++k) {
      of[3 * kMeanModes + k] = static_cast<float>(gust_basis_(i, static_cast<Eigen::Index>(k)));
    }
  }
}

Matrix Nuisances::known_for(const FlowMaps& maps, std::uint64_t seed, int threads) const {
  const Errors errors = drawn_errors(maps, centres(cells_, extent_), seed, threads);
  Matrix covariance = known();
  const auto fill = [&](const Matrix& basis, const Matrix& of, Eigen::Index first) {
    const Matrix amplitudes = least_squares(basis, of);
    auto block = covariance.block(first, first, basis.cols(), basis.cols());
    block = amplitudes * amplitudes.transpose();
    block.diagonal().array() += kLeastVariance;
  };
  fill(mean_basis_, errors.mean, kParameters);
  fill(gust_basis_, errors.gusts, kParameters + mean_basis_.cols());
  return symmetric_inverse(covariance);
}

void Nuisances::push(const Features& features, const Kinematics& k, std::size_t i,
                     std::size_t first, Pushes& pushes) const {
  const Model& model = features.model();
  const double mass = model.module.mass, inertia = model.module.inertia();
  std::size_t at = first;
  const auto push = [&](double ax, double ay, double turn) {
    pushes.x[at] = static_cast<float>(ax), pushes.y[at] = static_cast<float>(ay);
    pushes.turn[at] = static_cast<float>(turn), ++at;
  };
  const auto by = [&](const Wrench& w, double size) {
    push(size * w.fx / mass, size * w.fy / mass, size * w.torque / inertia);
  };
  const auto& [drag, flow, linear, angular, gusts] = kModelParameters;
  by(features.drag(i), drag.size), by(features.by_gain(i), flow.size);
  push(-linear.size * k.vx[i], -linear.size * k.vy[i], 0);
  push(0, 0, -angular.size * k.omega[i]);
  by(features.by_gusts(i), gusts.size);
  if (cells_ > 0) push_flow(features, k.x[i], k.y[i], i, at, pushes);
}

// Bilinear between the centres of four cells, as the flow itself.
void Nuisances::push_flow(const Features& features, double x, double y, std::size_t i,
                          std::size_t first, Pushes& pushes) const {
  const double pitch = 2 * extent_ / cells_;
  const auto place = [&](double at) {
    return std::clamp((at + extent_) / pitch - 0.5, 0.0, cells_ - 1.001);
  };
  const double gx = place(x), gy = place(y);
  const auto column = static_cast<std::size_t>(gx), row = static_cast<std::size_t>(gy);
  const auto fx = static_cast<float>(gx - std::floor(gx)),
             fy = static_cast<float>(gy - std::floor(gy));
  const std::size_t cell = row * static_cast<std::size_t>(cells_) + column;
  const auto of_cell = [&](std::size_t at) { return &changes_[at * kOfCell]; };
  const auto below = cell + static_cast<std::size_t>(cells_);
  const std::array<const float*, 4> corners{of_cell(cell), of_cell(cell + 1), of_cell(below),
                                            of_cell(below + 1)};
  const std::array<float, 4> weights{(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
  std::array<float, kOfCell> here;
  mix_rows(corners.data(), weights.data(), corners.size(), here.size(), here.data());
  const std::array<const float*, 3> flow{&here[0], &here[kMeanModes], &here[2 * kMeanModes]};
  const float* gusts = &here[3 * kMeanModes];
  const Model& model = features.model();
  const auto push = [&](double Wrench::*part, double inertia, float* to) {
    const auto of = [&](const Wrench& w) { return static_cast<float>(w.*part / inertia); };
    const std::array<float, 3> by{of(features.by_x(i)), of(features.by_y(i)),
                                  of(features.by_turning(i))};
    mix_rows(flow.data(), by.data(), flow.size(), kMeanModes, to);
    const float by_gusts = of(features.by_gusts(i));
    mix_rows(&gusts, &by_gusts, 1, kGustModes, to + kMeanModes);
  };
  push(&Wrench::fx, model.module.mass, &pushes.x[first]);
  push(&Wrench::fy, model.module.mass, &pushes.y[first]);
  push(&Wrench::torque, model.module.inertia(), &pushes.turn[first]);
}

}  // namespace lilytank
