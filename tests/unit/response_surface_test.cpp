// Response surfaces: a quadratic is found exactly, and intervals are those of theory.
#include "lilytank/response_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

double noise_of(std::int64_t row, std::uint32_t column, std::uint32_t what) {
  return normal_pair({7, Stream::calibrate, row, column, what})[0];
}

/// Six numbers of two parameters, quadratic in them.
Vector truth(const Vector& p) {
  Vector out(6);
  out << 1 + p(0), 2 - p(1) + 0.3 * p(0) * p(0), p(0) + p(1), 0.5 * p(0) * p(1), 3,
      p(1) * p(1) - p(0);
  return out;
}

/// Simulations about (0.5, -0.2) with noise of the same deviation in every number but the fifth.
Design design(int count, double noise) {
  Design out{Matrix(count, 2), Matrix(count, 6)};
  for (int i = 0; i < count; ++i) {
    out.points.row(i) << 0.5 + 0.3 * noise_of(i, 0, 100), -0.2 + 0.2 * noise_of(i, 1, 100);
    out.numbers.row(i) = truth(out.points.row(i));
    for (int k = 0; k < 6; ++k) {
      if (k != 4) out.numbers(i, k) += noise * noise_of(i, static_cast<std::uint32_t>(k), 101);
    }
  }
  return out;
}

TEST(ResponseSurface, findsAQuadraticAndItsParameters) {
  for (const Misfit misfit : {Misfit::covariance, Misfit::absolute}) {
    const ResponseSurface model(design(60, 1e-7), misfit);
    Vector at(2);
    at << 0.7, -0.35;
    EXPECT_LT((model.mean(at) - truth(at)).norm(), 1e-5);
    Matrix slope(6, 2);
    slope << 1, 0, 0.6 * at(0), -1, 1, 1, 0.5 * at(1), 0.5 * at(0), 0, 0, -1, 2 * at(1);
    EXPECT_LT((model.slope(at) - slope).norm(), 1e-4);
    const LocalFit fit = model.fit(truth(at));
    EXPECT_LT((fit.point - at).norm(), 1e-4);
    EXPECT_FALSE(fit.at_bound);
  }
}

TEST(ResponseSurface, intervalsFromTheCovarianceAreThoseThatScatterShows) {
  const double noise = 0.02;
  const ResponseSurface model(design(400, noise));
  Vector at(2);
  at << 0.5, -0.2;
  const Matrix expected = model.parameter_covariance(at);
  const int n = 2000;
  Matrix found(n, 2);
  double misfit = 0;
  for (int i = 0; i < n; ++i) {
    Vector data = truth(at);
    for (int k = 0; k < 6; ++k) {
      if (k != 4) data(k) += noise * noise_of(i, static_cast<std::uint32_t>(k), 102);
    }
    const LocalFit fit = model.fit(data);
    found.row(i) = fit.point;
    misfit += fit.misfit / n;
  }
  const Vector mean = found.colwise().mean();
  const Matrix off = found.rowwise() - mean.transpose();
  const Matrix scatter = off.transpose() * off / (n - 1);
  for (int k = 0; k < 2; ++k) {
    // The model's own error: 1 / sqrt(400) of the noise at the centre, a little more with
    // quadratics.
    EXPECT_NEAR(mean(k), at(k), 0.3 * std::sqrt(expected(k, k)));
    // Deviations from 2000 are known to 1.6 %, the covariance from 400 to some 4 %.
    EXPECT_NEAR(std::sqrt(scatter(k, k) / expected(k, k)), 1, 0.12);
  }
  // Five numbers that vary, less two parameters.
  EXPECT_NEAR(misfit, 3, 0.4);
}

TEST(ResponseSurface, aProfileRisesByOneAtAStandardError) {
  const ResponseSurface model(design(400, 0.02));
  Vector at(2);
  at << 0.5, -0.2;
  const LocalFit best = model.fit(truth(at));
  const double error = std::sqrt(model.parameter_covariance(best.point)(0, 0));
  for (const double side : {-1, 1}) {
    const LocalFit held = model.fit_with(truth(at), 0, best.point(0) + side * error);
    EXPECT_DOUBLE_EQ(held.point(0), best.point(0) + side * error);
    EXPECT_NEAR(held.misfit - best.misfit, 1, 0.15);
  }
}

TEST(ResponseSurface, boundsHoldAndReachIsTold) {
  const ResponseSurface model(design(60, 1e-7));
  Vector at(2);
  at << 0.7, -0.35;
  FitBounds bounds;
  bounds.low = Vector::Constant(2, -1), bounds.high = Vector::Constant(2, 0.6);
  const LocalFit fit = model.fit(truth(at), bounds);
  EXPECT_DOUBLE_EQ(fit.point(0), 0.6);
  at << 5, -0.2;
  FitBounds near;
  near.reach = 1;
  EXPECT_TRUE(model.fit(truth(at), near).at_bound);
}

// Data that the model explains outweigh what was known before; data that it does not explain must
// not push parameters about.
TEST(ResponseSurface, whatIsNotExplainedLeavesParametersWhereTheyWereExpected) {
  const ResponseSurface model(design(400, 0.02));
  Vector expected(2), at(2);
  expected << 0.5, -0.2, at << 0.7, -0.35;
  const Prior prior{expected, Vector::Constant(2, 0.3)};
  const MapEstimate explained = model.fit(truth(at), {}, prior);
  EXPECT_EQ(explained.dispersion, 1);
  EXPECT_LT((explained.fit.point - at).norm(), 0.02);
  Vector odd = truth(expected);
  odd(1) += 2;  // a hundred of its deviations
  FitBounds near;
  near.reach = 10;
  const MapEstimate unexplained = model.fit(odd, near, prior);
  EXPECT_GT(unexplained.dispersion, 100);
  EXPECT_LT((unexplained.fit.point - expected).norm(),
            0.6 * (model.fit(odd, near).point - expected).norm());
  EXPECT_GT(unexplained.covariance(0, 0), 30 * explained.covariance(0, 0));
}

// Two of 150 numbers tell the parameter; 60 simulations leave slopes of noise in all others.
TEST(ResponseSurface, shrunkSlopesDoNotHoldAnswersToTheCentre) {
  constexpr int kSimulations = 60, kNumbers = 150;
  Design d{Matrix(kSimulations, 1), Matrix(kSimulations, kNumbers)};
  const auto numbers = [&](int row, double at) {
    Vector out(kNumbers);
    for (int k = 0; k < kNumbers; ++k) {
      out(k) = noise_of(row, static_cast<std::uint32_t>(k), 201) + (k < 2 ? 0.7 * at : 0);
    }
    return out;
  };
  for (int i = 0; i < kSimulations; ++i) {
    d.points(i, 0) = noise_of(i, 0, 200);
    d.numbers.row(i) = numbers(i, d.points(i, 0));
  }
  const auto slope_of_answers = [&](Slopes slopes) {
    const ResponseSurface model(d, Misfit::covariance, slopes);
    double both = 0, square = 0;
    for (int i = kSimulations; i < kSimulations + 400; ++i) {
      const double at = i % 2 == 0 ? 1 : -1;
      both += model.fit(numbers(i, at)).point(0) * at, square += 1;
    }
    return both / square;
  };
  EXPECT_LT(slope_of_answers(Slopes::found), 0.6);
  EXPECT_GT(slope_of_answers(Slopes::shrunk), 0.75);
}

// Statistics of which one is curved and the others are not: the curve stays, the noise of the
// others' curvatures goes.
TEST(ResponseSurface, StraightenedSurfacesKeepCurvesThatAreClear) {
  const Design d = design(60, 0.01);
  const ResponseSurface found(d), straight(d, Misfit::covariance, Slopes::straightened);
  Vector left(2), right(2), middle = Vector::Zero(2);
  left << -2, 0, right << 2, 0;
  const auto bend = [&](const ResponseSurface& model) -> Vector {
    return 0.5 * (model.mean(left) + model.mean(right)) - model.mean(middle);
  };
  const double truly = (0.5 * (truth(left) + truth(right)) - truth(middle))(1);
  EXPECT_NEAR(bend(straight)(1), truly, 0.15 * truly);
  double noise_found = 0, noise_straight = 0;
  for (const Eigen::Index linear : {0, 2}) {
    noise_found += std::fabs(bend(found)(linear));
    noise_straight += std::fabs(bend(straight)(linear));
  }
  EXPECT_LT(noise_straight, 0.5 * noise_found);
}

// A number that does not depend on a parameter does not move it, whatever chance has its slope be;
// the other numbers do as they did.
TEST(ResponseSurface, independentNumbersDoNotMoveAParameter) {
  Design d = design(60, 0.05);
  d.independent = Matrix::Zero(6, 2), d.independent(2, 0) = d.independent(5, 0) = 1;
  const ResponseSurface model(d, Misfit::covariance), all(design(60, 0.05));
  Vector at(2);
  at << 0.7, -0.35;
  const Matrix slope = model.slope(at);
  // In standard parameters; those of the axes differ by the sampled correlation of two of them.
  EXPECT_LT(std::fabs(slope(2, 0)), 0.1 * std::fabs(all.slope(at)(2, 0)));
  EXPECT_LT(std::fabs(slope(5, 0)), 0.1 * std::fabs(all.slope(at)(5, 0)));
  EXPECT_DOUBLE_EQ(slope(0, 0), all.slope(at)(0, 0));
  EXPECT_NEAR(slope(2, 1), 1, 0.1);
  EXPECT_NEAR(model.fit(truth(at)).point(0), 0.7, 0.05);
}

TEST(ResponseSurface, tooFewSimulationsAreRefused) {
  EXPECT_THROW(ResponseSurface(design(6, 0.1)), std::invalid_argument);
  EXPECT_NO_THROW(ResponseSurface(design(9, 0.1)));  // without products of the two
}

}  // namespace
}  // namespace lilytank
