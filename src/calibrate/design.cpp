#include "calibrate/design.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/error.hpp"
#include "lilytank/random.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kFar = 1.5;  // farthest points, over the root of their dimension

}  // namespace

Matrix scattered(const Vector& centre, const Matrix& spread, int count, const FitBounds& bounds,
                 std::uint64_t seed) {
  const Eigen::Index p = centre.size();
  Matrix points(count, p);
  for (int i = 0; i < count; ++i) {
    Vector z(p);
    for (Eigen::Index k = 0; k < p; ++k) {
      z(k) = normal_pair({seed, Stream::calibrate, i / 2, static_cast<std::uint32_t>(k), 2})[0];
    }
    // Distant points would bias the quadratic at the centre.
    const double far = z.norm() / (kFar * std::sqrt(static_cast<double>(p)));
    if (far > 1) z /= far;
    Vector at = centre + (i % 2 == 0 ? 1 : -1) * (spread * z);
    for (Eigen::Index k = 0; k < p; ++k) {
      if (at(k) < bounds.low(k)) at(k) = 2 * bounds.low(k) - at(k);
      if (at(k) > bounds.high(k)) at(k) = 2 * bounds.high(k) - at(k);
      at(k) = std::clamp(at(k), bounds.low(k), bounds.high(k));
    }
    points.row(i) = at;
  }
  return points;
}

Matrix spread_of(const Matrix& covariance, double errors, const Vector& most) {
  Matrix c = covariance;
  for (Eigen::Index k = 0; k < c.rows(); ++k) c(k, k) += 1e-8 * most(k) * most(k);
  Matrix root = errors * lower_root(c);
  for (Eigen::Index k = 0; k < c.rows(); ++k) {
    const double size = root.row(k).norm();
    if (size > most(k)) root.row(k) *= most(k) / size;
  }
  return root;
}

Design design_of(const Matrix& points, const std::vector<std::vector<double>>& rows) {
  std::vector<Eigen::Index> good;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].empty()) good.push_back(static_cast<Eigen::Index>(i));
  }
  if (good.empty() || 2 * good.size() < rows.size()) {
    throw InputError("more than half of the simulations about an answer diverged");
  }
  const auto n = static_cast<Eigen::Index>(good.size());
  const auto width = static_cast<Eigen::Index>(rows[static_cast<std::size_t>(good[0])].size());
  Design out{points(good, Eigen::all), Matrix(n, width)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& row = rows[static_cast<std::size_t>(good[static_cast<std::size_t>(i)])];
    out.numbers.row(i) = Eigen::Map<const Vector>(row.data(), width);
  }
  return out;
}

Design joined(const Design& above, const Design& below) {
  const Eigen::Index n = above.points.rows() + below.points.rows();
  Design out{Matrix(n, above.points.cols()), Matrix(n, above.numbers.cols())};
  out.points << above.points, below.points;
  out.numbers << above.numbers, below.numbers;
  return out;
}

Design with_columns(const Design& design, const std::vector<Eigen::Index>& columns) {
  return {design.points, design.numbers(Eigen::all, columns), design.independent};
}

Eigen::MatrixXd rows_without_fold(const Eigen::MatrixXd& of, int fold, int folds) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < of.rows(); ++i) {
    if (i % folds != fold) rows.push_back(i);
  }
  return of(rows, Eigen::all);
}

Design without_fold(const Design& design, int fold, int folds) {
  return {rows_without_fold(design.points, fold, folds),
          rows_without_fold(design.numbers, fold, folds), design.independent};
}

Matrix shrunk_correlations(const Matrix& z, double least) {
  const auto n = static_cast<double>(z.rows());
  Matrix r = z.transpose() * z / n;
  const Matrix squares = z.array().square().matrix();
  const Matrix fourth = squares.transpose() * squares / n;
  double variance = 0, size = 0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      variance += std::max(0.0, fourth(i, j) - r(i, j) * r(i, j)) / n;
      size += r(i, j) * r(i, j);
    }
  }
  r *= 1 - std::max(least, size > 0 ? std::clamp(variance / size, 0.0, 1.0) : 1);
  r.diagonal().setOnes();
  return r;
}

}  // namespace lilytank
