#include "calibrate/estimate_line.hpp"

#include <cmath>

#include "statistics/linear.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// From the covariance of the estimate and its distance from the line's centre.
void set_deviation(const Line& line, const Matrix& covariance, const Vector& off,
                   ParameterEstimate& out) {
  out.deviation = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const Vector inverse = out.deviation.cwiseMax(1e-300).cwiseInverse();
  out.correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  Vector x = Vector::Zero(line.inverse.rows());
  x(0) = 1;
  if (x.size() > 1) x.tail(x.size() - 1) = off;
  out.wide = student_half_width(line.freedom) * std::sqrt(1 + x.dot(line.inverse * x));
}

}  // namespace

Line line_through(const Matrix& off, const Matrix& values) {
  const Eigen::Index n = off.rows(), p = off.isZero(0) ? 0 : off.cols();
  Matrix x(n, 1 + p);
  x.col(0).setOnes();
  x.rightCols(p) = off.leftCols(p);
  const Matrix found = least_squares(x, values);
  Line out;
  out.at_centre = found.row(0);
  out.slope = p > 0 ? Matrix(found.bottomRows(p).transpose())
                    : Matrix(Matrix::Identity(values.cols(), off.cols()));
  out.residuals = values - x * found;
  out.freedom = static_cast<double>(n - 1 - p);
  out.covariance = out.residuals.transpose() * out.residuals / out.freedom;
  out.inverse = symmetric_inverse(x.transpose() * x);
  return out;
}

// The posterior given the estimate.
ParameterEstimate estimate_of(const Line& line, const Vector& centre, const Vector& answer,
                              const Prior& prior) {
  ParameterEstimate out;
  const Matrix before = prior.deviation.array().square().matrix().asDiagonal();
  const Matrix answers = line.slope * before * line.slope.transpose() + line.covariance;
  out.back = solve_symmetric(answers, Matrix(line.slope * before)).transpose();
  const Vector expected = line.at_centre + line.slope * (prior.expected - centre);
  out.estimate = prior.expected + out.back * (answer - expected);
  set_deviation(line, before - out.back * line.slope * before, out.estimate - centre, out);
  return out;
}

}  // namespace lilytank
