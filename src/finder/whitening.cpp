#include "finder/whitening.hpp"

#include <cmath>

#include "calibrate/design.hpp"
#include "forces/empirical_force.hpp"
#include "scores/scores.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kLeastShrinkage = 0.02;
constexpr Eigen::Index kLeastScatter = 4;
constexpr double kExcessAside = 0.1;  // of an excess, that is not along what few experiments show
constexpr double kByChance = 2;  // deviations of a variance that few experiments show of nothing

// Covariance from shrunk correlations of the columns and given deviations.
Matrix shrunk_covariance(const Matrix& off, const Vector& deviation) {
  const Vector own = (off.colwise().squaredNorm() / static_cast<double>(off.rows()))
                         .cwiseSqrt()
                         .cwiseMax(1e-9)
                         .transpose();
  const Matrix z = off * own.cwiseInverse().asDiagonal();
  return deviation.asDiagonal() * shrunk_correlations(z, kLeastShrinkage) * deviation.asDiagonal();
}

Matrix inverse_root(const Matrix& covariance) {
  return lower_inverse(lower_root(covariance));
}

// Covariance of few experiments, its correlations shrunk towards the expected ones: the expected
// ones are removed first, and the rest is shrunk towards 0.
Matrix covariance_of(const Matrix& rows, const Matrix& expected_root) {
  const Matrix off = rows.rowwise() - rows.colwise().mean();
  const Matrix plain = off * lower_inverse(expected_root).transpose();
  const Vector deviation = (plain.colwise().squaredNorm() / static_cast<double>(rows.rows()))
                               .cwiseSqrt()
                               .cwiseMax(1e-9)
                               .transpose();
  return expected_root * shrunk_covariance(plain, deviation) * expected_root.transpose();
}

// A covariance inflated by the excess scatter of few experiments.
Matrix inflated(const Matrix& own, const Matrix& off) {
  const auto n = static_cast<double>(off.rows());
  const double chance = 1 + kByChance * std::sqrt(2 / n);
  const Vector square = off.colwise().squaredNorm().transpose() / n;
  const Vector excess = (square - chance * own.diagonal()).cwiseMax(0).cwiseSqrt();
  // Most of the excess is along the directions that the experiments themselves span.
  const Vector share = excess.cwiseQuotient(square.cwiseSqrt().cwiseMax(1e-9));
  const Matrix along = off * share.asDiagonal();
  const Vector aside = std::sqrt(kExcessAside) * excess;
  return own + (1 + 1 / n) / n * (along.transpose() * along) +
         Matrix(aside.cwiseAbs2().asDiagonal());
}

}  // namespace

Eigen::Index Whitening::first_knot(std::size_t curve) const {
  return named + static_cast<Eigen::Index>(curve) * kKnots;
}

Matrix Whitening::whitened(const Matrix& residuals) const {
  Matrix out(residuals.rows(), residuals.cols());
  out.topRows(named) = whitener * residuals.topRows(named);
  for (std::size_t s = 0; s < curves(); ++s) {
    const Eigen::Index first = first_knot(s);
    out.middleRows(first, kKnots) = knot_whitener[s] * residuals.middleRows(first, kKnots);
  }
  return out;
}

Vector Whitening::of(const Vector& residual) const {
  return whitened(residual - centre);
}

double Whitening::misfit(const Vector& residual) const {
  return (whitener * (residual - centre).head(named)).squaredNorm();
}

Matrix Whitening::whitener_by(const Matrix& scatter) const {
  if (scatter.rows() < kLeastScatter) return inverse_root(covariance);
  const Matrix plain = lower_inverse(expected_root);
  const Matrix own = plain * covariance * plain.transpose();
  return inverse_root(inflated(own, scatter.leftCols(named) * plain.transpose())) * plain;
}

Whitening whitening_by_nulls(const Matrix& nulls, const Matrix& expected_correlation,
                             std::size_t curves) {
  Whitening out;
  out.named = nulls.cols() - static_cast<Eigen::Index>(curves) * kKnots;
  out.expected_root = Matrix::Identity(out.named, out.named);
  Matrix expected = expected_correlation;
  expected.diagonal().array() += kUniqueVariance;
  const Eigen::Index first = expected.rows();
  if (expected.size() > 0) out.expected_root.topLeftCorner(first, first) = lower_root(expected);
  out.centre = nulls.colwise().mean().transpose();
  const auto n = static_cast<double>(nulls.rows());
  // By all nulls, also where some are left out: by chance these scatter less than all.
  const Matrix off = nulls.leftCols(out.named).rowwise() - out.centre.head(out.named).transpose();
  out.missing = (1 - off.colwise().squaredNorm().transpose().array() / (n - 1)).cwiseMax(0);
  for (std::size_t s = 0; s < curves; ++s) {
    const Eigen::Index at = out.first_knot(s);
    const Matrix block =
        nulls.middleCols(at, kKnots).rowwise() - out.centre.segment(at, kKnots).transpose();
    out.knot_covariance.emplace_back(block.transpose() * block / (n - 1));
    // The deviation of rarely visited knots is overestimated rather than underestimated.
    Matrix& knots = out.knot_covariance.back();
    knots.diagonal() = knots.diagonal().cwiseMax(1.0);
    out.knot_whitener.push_back(inverse_root(knots));
  }
  return with_nulls(std::move(out), nulls);
}

Whitening with_nulls(Whitening w, const Matrix& nulls) {
  w.covariance = covariance_of(nulls.leftCols(w.named), w.expected_root);
  w.covariance.diagonal() += w.missing;
  w.whitener = inverse_root(w.covariance);
  return w;
}

Whitening with_variance(Whitening w, const Vector& variance) {
  w.covariance.diagonal() += variance;
  w.whitener = inverse_root(w.covariance);
  return w;
}

Whitening with_scatter(Whitening w, const Matrix& scatter) {
  if (scatter.rows() < kLeastScatter) return w;
  w.whitener = w.whitener_by(scatter);
  for (std::size_t s = 0; s < w.curves(); ++s) {
    w.knot_whitener[s] =
        inverse_root(inflated(w.knot_covariance[s], scatter.middleCols(w.first_knot(s), kKnots)));
  }
  return w;
}

}  // namespace lilytank
