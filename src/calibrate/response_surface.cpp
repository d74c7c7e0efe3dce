#include "lilytank/response_surface.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calibrate/design.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kMostSteps = 60;
constexpr double kNeverVaries = 1e-10;
constexpr int kDispersionRounds = 3;  // rounds of reweighting until the dispersion is stable
constexpr double kNoise = 2;  // standard errors up to which a coefficient is taken for noise

Eigen::Index coefficients_of(Eigen::Index p, bool products) {
  return 1 + 2 * p + (products ? p * (p - 1) / 2 : 0);
}

}  // namespace

ResponseSurface::ResponseSurface(const Design& design, Misfit misfit, Slopes slopes)
    : kind_(misfit) {
  const Eigen::Index n = design.points.rows(), p = design.points.cols();
  products_ = n >= 2 * coefficients_of(p, true);
  const Eigen::Index q = coefficients_of(p, products_);
  if (n <= q + 1) throw std::invalid_argument("too few simulations for a response surface");
  centre_ = design.points.colwise().mean();
  const Matrix off = design.points.rowwise() - centre_.transpose();
  Matrix spread = off.transpose() * off / static_cast<double>(n - 1);
  spread.diagonal().array() += 1e-14;
  unit_ = lower_root(spread);
  to_unit_ = lower_inverse(unit_);
  Matrix x(n, q);
  for (Eigen::Index i = 0; i < n; ++i) x.row(i) = basis(standard(design.points.row(i)));
  coefficients_ = least_squares(x, design.numbers).transpose();
  if (design.independent.size() > 0) clear(design.independent);
  find_covariance(design.numbers - x * coefficients_.transpose(), static_cast<double>(n - q));
  if (slopes == Slopes::found) return;
  const Vector errors = symmetric_inverse(x.transpose() * x).diagonal();
  shrink(errors.cwiseSqrt(), slopes == Slopes::shrunk ? 1 : 1 + p);
}

void ResponseSurface::anchor(const Vector& point, const Matrix& numbers) {
  const Vector average = numbers.colwise().mean();
  coefficients_.col(0) += average - mean(point);
  find_covariance(numbers.rowwise() - average.transpose(), static_cast<double>(numbers.rows() - 1));
}

// The coefficients of what numbers do not depend on. Points are scattered along the axes: standard
// parameters are the parameters but for their sampled correlations.
void ResponseSurface::clear(const Matrix& independent) {
  const Matrix depends = Matrix::Ones(independent.rows(), independent.cols()) - independent;
  const Eigen::Index p = depends.cols();
  for (Eigen::Index i = 0, at = 1 + 2 * p; i < p; ++i) {
    coefficients_.col(1 + i).array() *= depends.col(i).array();
    coefficients_.col(1 + p + i).array() *= depends.col(i).array();
    for (Eigen::Index j = 0; products_ && j < i; ++j, ++at) {
      coefficients_.col(at).array() *= depends.col(i).array() * depends.col(j).array();
    }
  }
}

// Shrinks coefficients, from one on, by their ratio to their errors [Breiman's garrote,
// Technometrics 37, 1995]: a hundred statistics that depend on a parameter by noise alone would
// seem to constrain it, and bias the estimate to the centre.
void ResponseSurface::shrink(const Vector& errors, Eigen::Index from) {
  for (Eigen::Index k = 0; k < coefficients_.rows(); ++k) {
    const double deviation = std::sqrt(covariance_(k, k));
    for (Eigen::Index j = from; j < coefficients_.cols(); ++j) {
      const double noise = kNoise * deviation * errors(j), size = coefficients_(k, j);
      const double ratio = size != 0 ? noise / size : 0;
      coefficients_(k, j) *= std::max(0.0, 1 - ratio * ratio);
    }
  }
}

void ResponseSurface::find_covariance(const Matrix& residuals, double freedom) {
  const Eigen::Index d = residuals.cols();
  const Vector deviation = (residuals.colwise().squaredNorm() / freedom).cwiseSqrt();
  Matrix z = residuals;
  for (Eigen::Index k = 0; k < d; ++k) {
    z.col(k) /= std::max(deviation(k), kNeverVaries) *
                std::sqrt(freedom / static_cast<double>(residuals.rows()));
  }
  const Matrix correlation = shrunk_correlations(z);
  covariance_ = deviation.asDiagonal() * correlation * deviation.asDiagonal();
  whitener_ = lower_inverse(lower_root(correlation));
  for (Eigen::Index k = 0; k < d; ++k) {
    whitener_.col(k) *= deviation(k) > kNeverVaries ? 1 / deviation(k) : 0;
  }
  if (kind_ == Misfit::absolute) whitener_ = Matrix::Identity(d, d);
}

Vector ResponseSurface::standard(const Vector& point) const {
  return to_unit_ * (point - centre_);
}

Vector ResponseSurface::basis(const Vector& z) const {
  const Eigen::Index p = z.size();
  Vector out(coefficients_of(p, products_));
  out(0) = 1, out.segment(1, p) = z, out.segment(1 + p, p) = z.array().square();
  Eigen::Index at = 1 + 2 * p;
  for (Eigen::Index i = 0; products_ && i < p; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) out(at++) = z(i) * z(j);
  }
  return out;
}

Matrix ResponseSurface::basis_slope(const Vector& z) const {
  const Eigen::Index p = z.size();
  Matrix out = Matrix::Zero(coefficients_of(p, products_), p);
  for (Eigen::Index i = 0; i < p; ++i) out(1 + i, i) = 1, out(1 + p + i, i) = 2 * z(i);
  Eigen::Index at = 1 + 2 * p;
  for (Eigen::Index i = 0; products_ && i < p; ++i) {
    for (Eigen::Index j = 0; j < i; ++j, ++at) out(at, i) = z(j), out(at, j) = z(i);
  }
  return out;
}

Vector ResponseSurface::mean(const Vector& point) const {
  return coefficients_ * basis(standard(point));
}

Matrix ResponseSurface::slope(const Vector& point) const {
  return coefficients_ * basis_slope(standard(point)) * to_unit_;
}

double ResponseSurface::misfit(const Vector& numbers, const Vector& point) const {
  const Vector r = whitener_ * (numbers - mean(point));
  return kind_ == Misfit::absolute ? r.cwiseAbs().sum() : r.squaredNorm();
}

Matrix ResponseSurface::parameter_covariance(const Vector& point) const {
  const Matrix a = whitener_ * slope(point);
  Matrix information = a.transpose() * a;
  information.diagonal().array() += 1e-12 * information.trace();
  const Matrix back = solve_symmetric(information, Matrix(a.transpose() * whitener_));
  return back * covariance_ * back.transpose();
}

Matrix ResponseSurface::parameter_covariance(const Vector& point, const Vector& prior) const {
  const Matrix a = whitener_ * slope(point);
  Matrix information = a.transpose() * a;
  information.diagonal() += prior.cwiseAbs2().cwiseInverse();
  return symmetric_inverse(information);
}

LocalFit ResponseSurface::fit(const Vector& numbers, const FitBounds& bounds) const {
  return solve(numbers, -1, 0, bounds, {});
}

MapEstimate ResponseSurface::fit(const Vector& numbers, const FitBounds& bounds,
                                 const Prior& prior) const {
  MapEstimate out;
  const auto freedom =
      static_cast<double>(std::max<Eigen::Index>(1, numbers.size() - prior.expected.size()));
  for (int k = 0; k < kDispersionRounds; ++k) {
    const Prior weighed{prior.expected, prior.deviation / out.dispersion};
    out.fit = solve(numbers, -1, 0, bounds, weighed);
    out.dispersion = std::max(1.0, out.fit.misfit / freedom);
  }
  // The dispersion must not narrow the prior's part of the covariance.
  out.covariance = out.dispersion *
                   parameter_covariance(out.fit.point, prior.deviation / std::sqrt(out.dispersion));
  return out;
}

LocalFit ResponseSurface::fit_with(const Vector& numbers, int parameter, double value,
                                   const FitBounds& bounds) const {
  return solve(numbers, parameter, value, bounds, {});
}

// One least-squares problem: Levenberg-Marquardt within a box, reweighted for absolute differences
// where the misfit is Misfit::absolute.
struct ResponseSurface::Problem {
  const ResponseSurface& model;
  const Vector& numbers;
  int held;
  Vector low, high;
  Vector expected = {}, weight = {};  ///< of what is known before; weights empty: nothing is

  double distance(const Vector& point) const {
    const double data = model.misfit(numbers, point);
    return weight.size() == 0 ? data : data + weight.dot((point - expected).cwiseAbs2());
  }

  // A step from `point` under damping, without parameters that are held by a bound.
  Vector step(const Vector& point, double damping) const {
    const Vector r = model.whitener_ * (numbers - model.mean(point));
    const Matrix a = model.whitener_ * model.slope(point);
    Vector share = Vector::Ones(r.size());
    if (model.kind_ == Misfit::absolute) {
      const double small = 1e-3 * r.cwiseAbs().mean() + 1e-300;
      share = r.cwiseAbs().cwiseMax(small).cwiseInverse();
    }
    Matrix h = a.transpose() * share.asDiagonal() * a;
    Vector g = a.transpose() * share.cwiseProduct(r);
    if (weight.size() > 0) {
      h.diagonal() += weight;
      g += weight.cwiseProduct(expected - point);
    }
    const double most = h.diagonal().maxCoeff();
    for (Eigen::Index k = 0; k < point.size(); ++k) {
      const bool stuck =
          k == held || (point(k) <= low(k) && g(k) < 0) || (point(k) >= high(k) && g(k) > 0);
      if (stuck) h.row(k).setZero(), h.col(k).setZero(), g(k) = 0;
      h(k, k) += damping * h(k, k) + 1e-12 * most + (stuck ? most : 0);
    }
    return (point + solve_symmetric(h, g)).cwiseMax(low).cwiseMin(high);
  }
};

LocalFit ResponseSurface::solve(const Vector& numbers, int held, double value,
                                const FitBounds& bounds, const Prior& prior) const {
  const Vector reach = bounds.reach * unit_.rowwise().norm();
  Problem problem{*this, numbers, held, centre_ - reach, centre_ + reach};
  if (bounds.low.size() > 0) {
    problem.low = problem.low.cwiseMax(bounds.low).cwiseMin(bounds.high);
    problem.high = problem.high.cwiseMin(bounds.high).cwiseMax(bounds.low);
  }
  if (prior.expected.size() > 0) {
    problem.expected = prior.expected;
    problem.weight = prior.deviation.cwiseAbs2().cwiseInverse();
  }
  Vector at = centre_.cwiseMax(problem.low).cwiseMin(problem.high);
  if (held >= 0) at(held) = problem.low(held) = problem.high(held) = value;
  double now = problem.distance(at), damping = 1e-2;
  for (int k = 0; k < kMostSteps && damping < 1e9; ++k) {
    const Vector next = problem.step(at, damping);
    const double then = problem.distance(next);
    if (!(then < now)) {
      damping *= 4;
      continue;
    }
    const bool done = now - then < 1e-9 * (1 + std::fabs(now));
    at = next, now = then, damping = std::max(damping / 5, 1e-9);
    if (done) break;
  }
  LocalFit out{at, misfit(numbers, at), false};
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    if (k == held) continue;
    const bool far = std::fabs(at(k) - centre_(k)) >= reach(k) * (1 - 1e-9);
    out.at_bound = out.at_bound || far;
  }
  return out;
}

}  // namespace lilytank
