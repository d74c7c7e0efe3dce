#include "scores/nuisances.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "lilytank/random.hpp"
#include "lilytank/study.hpp"
#include "scores/flow_uncertainty.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Sizes: of factors on drag, flow and gusts; of dampings, 1/s; of the flow's polynomials, m/s.
constexpr double kDrag = 0.3, kFlow = 0.15, kGusts = 0.2, kDamping = 0.3, kStream = 5e-3;
constexpr std::size_t kFactors = 6;
constexpr std::size_t kDegree = 8;
constexpr std::size_t kTerms = (kDegree + 1) * (kDegree + 2) / 2;
constexpr int kDraws = 600;
constexpr double kVisited = 0.9;  // of the radius: polynomials fit draws within

// Chebyshev's polynomials of one coordinate, and their derivatives.
struct Chebyshev {
  std::array<double, kDegree + 1> value{1}, slope{0};
  explicit Chebyshev(double x) {
    value[1] = x, slope[1] = 1;
    for (std::size_t d = 2; d <= kDegree; ++d) {
      value[d] = 2 * x * value[d - 1] - value[d - 2];
      slope[d] = 2 * value[d - 1] + 2 * x * slope[d - 1] - slope[d - 2];
    }
  }
};

// Products of the polynomials of x and of y (in radii of the tank) up to a total degree, and their
// gradients.
struct Polynomials {
  std::array<double, kTerms> value{}, by_x{}, by_y{};
  Polynomials(double x, double y) {
    const Chebyshev along(x), across(y);
    std::size_t at = 0;
    for (std::size_t d = 0; d <= kDegree; ++d) {
      for (std::size_t b = 0; b <= d; ++b, ++at) {
        value[at] = along.value[d - b] * across.value[b];
        by_x[at] = along.slope[d - b] * across.value[b];
        by_y[at] = along.value[d - b] * across.slope[b];
      }
    }
  }
};

// Accelerations by a velocity of the water that is a polynomial, along either axis: two of each.
void push_flow(const Polynomials& p, const Features& features, std::size_t i, std::size_t first,
               Pushes& pushes) {
  const Model& model = features.model();
  const double R = model.tank.radius;
  const Wrench &along_x = features.by_x(i), &along_y = features.by_y(i);
  const Wrench& turned = features.by_turning(i);
  // The rotation of the water is half the curl of its velocity.
  std::array<double, kTerms> u, by_u, by_v;
  for (std::size_t t = 0; t < kTerms; ++t) {
    u[t] = kStream * p.value[t];
    by_u[t] = -0.5 * kStream * p.by_y[t] / R, by_v[t] = 0.5 * kStream * p.by_x[t] / R;
  }
  std::array<double, 2 * kTerms> sums;
  const auto push = [&](double Wrench::*part, double inertia, std::vector<float>& to) {
    const double x = along_x.*part, y = along_y.*part, turn = turned.*part;
    for (std::size_t t = 0; t < kTerms; ++t) {
      sums[2 * t] = u[t] * x + by_u[t] * turn, sums[2 * t + 1] = u[t] * y + by_v[t] * turn;
    }
    scale_all(sums.data(), sums.size(), 1 / inertia, &to[first]);
  };
  push(&Wrench::fx, model.module.mass, pushes.x), push(&Wrench::fy, model.module.mass, pushes.y);
  push(&Wrench::torque, model.module.inertia(), pushes.turn);
}

}  // namespace

std::size_t nuisance_count() {
  return kFactors + 2 * kTerms;
}

void push_nuisances(const Features& features, const Kinematics& k, std::size_t i, std::size_t first,
                    Pushes& pushes) {
  const Model& model = features.model();
  const double mass = model.module.mass, inertia = model.module.inertia(), R = model.tank.radius;
  std::size_t at = first;
  const auto push = [&](double ax, double ay, double turn) {
    pushes.x[at] = static_cast<float>(ax), pushes.y[at] = static_cast<float>(ay);
    pushes.turn[at] = static_cast<float>(turn), ++at;
  };
  const auto by = [&](const Wrench& w, double size) {
    push(size * w.fx / mass, size * w.fy / mass, size * w.torque / inertia);
  };
  const double x = k.x[i] / R, y = k.y[i] / R;
  by(features.drag(i), kDrag), by(features.by_gain(i), kFlow);
  push(-kDamping * k.vx[i], -kDamping * k.vy[i], 0), push(0, 0, -kDamping * k.omega[i]);
  by(features.by_gusts(i), kGusts), by(features.by_gusts(i), kGusts * (x * x + y * y));
  push_flow(Polynomials(x, y), features, i, at, pushes);
}

Matrix nuisances_known(const Model& model, const FlowMaps& maps, std::uint64_t seed, int threads) {
  const FlowField& best = *maps.best();
  const double R = model.tank.radius, pitch = 2 * best.extent() / best.cells();
  std::vector<std::size_t> cells;
  std::vector<Polynomials> rows;
  for (std::size_t i = 0; i < best.samples().size(); ++i) {
    const auto wide = static_cast<std::size_t>(best.cells());
    const double x = (static_cast<double>(i % wide) + 0.5) * pitch - best.extent();
    const double y = (static_cast<double>(i / wide) + 0.5) * pitch - best.extent();
    if (std::hypot(x, y) > kVisited * R) continue;
    cells.push_back(i), rows.emplace_back(x / R, y / R);
  }
  const auto n = static_cast<Eigen::Index>(cells.size());
  constexpr auto terms = static_cast<Eigen::Index>(kTerms);
  Matrix basis(n, terms), off(n, 2 * kDraws);
  for (Eigen::Index c = 0; c < n; ++c) {
    basis.row(c) =
        Eigen::Map<const Eigen::RowVectorXd>(rows[static_cast<std::size_t>(c)].value.data(), terms);
  }
  for_each_world(kDraws, threads, [&](int d) {
    const auto drawn = perturbed_flow(maps, seed, seed, d);
    for (Eigen::Index c = 0; c < n; ++c) {
      const std::size_t i = cells[static_cast<std::size_t>(c)];
      off(c, d) = drawn->samples()[i].mu_x - best.samples()[i].mu_x;
      off(c, kDraws + d) = drawn->samples()[i].mu_y - best.samples()[i].mu_y;
    }
  });
  const Matrix fitted = least_squares(basis, off) * (model.flow.K_v / kStream);
  Matrix covariance = Matrix::Identity(static_cast<Eigen::Index>(nuisance_count()),
                                       static_cast<Eigen::Index>(nuisance_count()));
  // Rows 2 t and 2 t + 1 are the two axes of term t.
  Matrix both(2 * terms, kDraws);
  for (Eigen::Index t = 0; t < terms; ++t) {
    both.row(2 * t) = fitted.row(t).head(kDraws);
    both.row(2 * t + 1) = fitted.row(t).tail(kDraws);
  }
  const Matrix centred = both.colwise() - both.rowwise().mean();
  auto flow = covariance.bottomRightCorner(2 * terms, 2 * terms);
  flow = centred * centred.transpose() / (kDraws - 1.0);
  flow.diagonal().array() += 1e-4 + 1e-3 * flow.diagonal().array();
  return symmetric_inverse(covariance);
}

}  // namespace lilytank
