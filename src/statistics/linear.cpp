#include "statistics/linear.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace lilytank {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
// Singular values. A square matrix needs no QR before the rotations.
using Rotations = Eigen::JacobiSVD<Matrix, Eigen::NoQRPreconditioner>;

Matrix lower_root(const Matrix& a) {
  return a.llt().matrixL();
}

Matrix lower_inverse(const Matrix& lower) {
  return lower.triangularView<Eigen::Lower>().solve(Matrix::Identity(lower.rows(), lower.cols()));
}

Vector solve_lower(const Matrix& lower, const Vector& b) {
  return lower.triangularView<Eigen::Lower>().solve(b);
}

Vector solve_symmetric(const Matrix& a, const Vector& b) {
  return a.ldlt().solve(b);
}

Matrix solve_symmetric(const Matrix& a, const Matrix& b) {
  return a.ldlt().solve(b);
}

Matrix symmetric_inverse(const Matrix& a) {
  return solve_symmetric(a, Matrix(Matrix::Identity(a.rows(), a.cols())));
}

Matrix least_squares(const Matrix& x, const Matrix& y) {
  return x.colPivHouseholderQr().solve(y);
}

Matrix floored_inverse(const Matrix& a, double least) {
  const Rotations of(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector inverse = of.singularValues().cwiseMax(least).cwiseInverse();
  return of.matrixV() * inverse.asDiagonal() * of.matrixU().transpose();
}

RankedSolution solve_ranked(const Matrix& a, const Vector& b, double threshold) {
  Rotations solver(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  solver.setThreshold(threshold);
  return {solver.solve(b), solver.rank()};
}

}  // namespace lilytank
