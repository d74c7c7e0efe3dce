#include "statistics/linear.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics/median.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kRounding = 1e-12;

const Matrix kSymmetric = (Matrix(3, 3) << 4, 2, 0.4, 2, 5, -1, 0.4, -1, 3).finished();
const Vector kRight = (Vector(3) << 1, -2, 0.5).finished();

TEST(Linear, RootAndItsInverseMakeUpTheMatrix) {
  const Matrix root = lower_root(kSymmetric);
  EXPECT_EQ(root(0, 2), 0);
  EXPECT_TRUE((root * root.transpose()).isApprox(kSymmetric, kRounding));
  EXPECT_TRUE((lower_inverse(root) * root).isIdentity(kRounding));
  EXPECT_TRUE((root * solve_lower(root, kRight)).isApprox(kRight, kRounding));
}

TEST(Linear, SymmetricSystemsAreSolved) {
  const Vector x = solve_symmetric(kSymmetric, kRight);
  EXPECT_TRUE((kSymmetric * x).isApprox(kRight, kRounding));
  const Matrix both = (Matrix(3, 2) << kRight, 2 * kRight).finished();
  EXPECT_TRUE(solve_symmetric(kSymmetric, both).col(1).isApprox(2 * x, kRounding));
  EXPECT_TRUE((symmetric_inverse(kSymmetric) * kSymmetric).isIdentity(kRounding));
}

TEST(Linear, AFlooredInverseIsOneWhereNothingIsBelow) {
  const Matrix a = (Matrix(2, 2) << 2, 1, -1, 3).finished();
  EXPECT_TRUE((floored_inverse(a, 0.1) * a).isIdentity(kRounding));
  // Of a turn of (4, 0.01) by another turn only the small one is raised.
  const Matrix thin = (Matrix(2, 2) << 0, 0.01, 4, 0).finished();
  const Matrix expected = (Matrix(2, 2) << 0, 0.25, 2, 0).finished();
  EXPECT_TRUE(floored_inverse(thin, 0.5).isApprox(expected, kRounding));
}

TEST(Linear, LeastSquaresLeaveWhatIsOrthogonal) {
  const Matrix x = (Matrix(4, 2) << 1, 0, 1, 1, 1, 2, 1, 3).finished();
  const Matrix y = (Matrix(4, 1) << 1, 3, 4, 9).finished();
  const Matrix c = least_squares(x, y);
  EXPECT_NEAR((x.transpose() * (y - x * c)).norm(), 0, 1e-11);
  EXPECT_NEAR(c(1), 2.5, kRounding);
}

TEST(Linear, TheShortestSolutionTellsTheRank) {
  const Matrix twice = (Matrix(2, 2) << 1, 1, 1, 1).finished();
  const RankedSolution found = solve_ranked(twice, Vector::Constant(2, 3), 1e-10);
  EXPECT_EQ(found.rank, 1);
  EXPECT_NEAR(found.x(0), 1.5, kRounding);
  EXPECT_NEAR(found.x(1), 1.5, kRounding);
}

TEST(Median, IsTheMiddleOrTheUpperOfTwo) {
  EXPECT_EQ(median({5, 1, 3}), 3);
  EXPECT_EQ(median({5, 1, 3, 2}), 3);
  EXPECT_TRUE(std::isnan(median({})));
}

}  // namespace
}  // namespace lilytank
