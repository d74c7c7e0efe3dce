// Solvers of small dense systems, compiled once: each of Eigen's own costs every source that uses
// it seconds of compiling. Matrices of a fixed small size use Eigen directly.
#pragma once
#include <Eigen/Core>

namespace lilytank {

/// L of a = L L', lower triangular [Cholesky]; `a` is symmetric and positive definite.
Eigen::MatrixXd lower_root(const Eigen::MatrixXd& a);
/// L^-1 of a lower triangle.
Eigen::MatrixXd lower_inverse(const Eigen::MatrixXd& lower);
/// x of L x = b.
Eigen::VectorXd solve_lower(const Eigen::MatrixXd& lower, const Eigen::VectorXd& b);

/// x of a x = b for a symmetric `a`, which is regular [L D L' with pivots].
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
/// The same for each column of `b`.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXd symmetric_inverse(const Eigen::MatrixXd& a);

/// Coefficients c, [column of x, column of y], that make |x c - y|^2 least [QR with pivots].
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y);
/// The inverse of a square `a` whose singular values below `least` are raised to it.
Eigen::MatrixXd floored_inverse(const Eigen::MatrixXd& a, double least);

/// The shortest x that makes |a x - b| least, and the rank of the square matrix `a`: how many of
/// its singular values are larger than `threshold` times the largest.
struct RankedSolution {
  Eigen::VectorXd x;
  Eigen::Index rank = 0;
};
RankedSolution solve_ranked(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double threshold);

}  // namespace lilytank
