// What response surfaces say of simulations that they did not know, and what follows for data.
#include "calibrate/cross_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kNumbers = 40;
constexpr double kWeak =
    0.16;  // slope of all numbers in the second parameter: 1 deviation tells it

double draw_of(std::int64_t row, int column, std::uint64_t trial) {
  return normal_pair({trial, Stream::calibrate, row, static_cast<std::uint32_t>(column), 3})[0];
}

// Numbers that tell the first parameter well and the second one hardly, in noise of deviation 1.
Design simulated(int count, std::uint64_t trial) {
  Design out{Matrix(count, 2), Matrix(count, kNumbers)};
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 2; ++k) out.points(i, k) = draw_of(i, k, trial);
    for (int k = 0; k < kNumbers; ++k) {
      const double sign = k % 2 == 0 ? 1 : -1;
      out.numbers(i, k) =
          out.points(i, 0) + kWeak * sign * out.points(i, 1) + draw_of(i, 2 + k, trial);
    }
  }
  return out;
}

// The first rows, and one more as data.
struct Drawn {
  Design design;
  Vector data, truth;
};
Drawn drawn(int count, std::uint64_t number) {
  const Design all = simulated(count + 1, number);
  return {{all.points.topRows(count), all.numbers.topRows(count)},
          all.numbers.row(count).transpose(),
          all.points.row(count).transpose()};
}

// Numbers that depend on nothing seem to tell the parameters of those who were asked before; by
// models that did not know a simulation its estimate has nothing to do with its parameters.
TEST(CrossFit, numbersOfNothingTellNothing) {
  Drawn t = drawn(200, 1);
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k < kNumbers; ++k) t.design.numbers(i, k) = draw_of(i, 100 + k, 1);
  }
  FitBounds free;
  free.reach = 5;
  const ResponseSurface model(t.design);
  const CrossFit others = cross_fit(t.design, t.data, Misfit::covariance, Slopes::found);
  double known = 0, unknown = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector own = model.fit(t.design.numbers.row(i).transpose(), free).point;
    known += own.dot(t.design.points.row(i)) / 200;
    unknown += others.estimates.row(i).dot(t.design.points.row(i)) / 200;
  }
  EXPECT_GT(known, 0.5);
  EXPECT_LT(std::fabs(unknown), 0.5);
}

// 300 intervals of 95 % hold with a deviation of 1.3 %; those of the response surface itself, which
// takes the noise of its slopes for knowledge, do not.
TEST(CrossFit, intervalsHoldWhatIsHardlyTold) {
  int held = 0, trusting = 0;
  constexpr int kTrials = 300;
  for (int i = 0; i < kTrials; ++i) {
    const Drawn t = drawn(80, static_cast<std::uint64_t>(100 + i));
    const CrossFit fit = cross_fit(t.design, t.data, Misfit::covariance, Slopes::found);
    const BiasCorrectedFit honest = bias_corrected(t.design, fit, 0);
    const double half = honest.wide * std::sqrt(honest.covariance(1, 1));
    held += std::fabs(honest.point(1) - t.truth(1)) < half ? 1 : 0;
    const ResponseSurface model(t.design);
    const LocalFit own = model.fit(t.data);
    const double claimed = 1.96 * std::sqrt(model.parameter_covariance(own.point)(1, 1));
    trusting += std::fabs(own.point(1) - t.truth(1)) < claimed ? 1 : 0;
  }
  EXPECT_GT(held, 0.91 * kTrials);
  EXPECT_LT(trusting, 0.85 * kTrials);
}

// Where everything is told well nothing is added: the error is that of least squares.
TEST(CrossFit, whatIsToldWellKeepsItsError) {
  const Drawn t = drawn(400, 7);
  const CrossFit fit = cross_fit(t.design, t.data, Misfit::covariance, Slopes::found);
  const BiasCorrectedFit honest = bias_corrected(t.design, fit, 0);
  const double expected = 1 / std::sqrt(kNumbers);
  EXPECT_NEAR(std::sqrt(honest.covariance(0, 0)), expected, 0.15 * expected);
  EXPECT_NEAR(honest.wide, 1.96, 0.05);
  EXPECT_EQ(honest.errors.rows(), 400);
}

// The same in a tenth of the noise, and curved beyond what a quadratic surface follows.
Design curved(const Matrix& points, std::uint64_t trial) {
  Design out{points, Matrix(points.rows(), kNumbers)};
  for (int i = 0; i < points.rows(); ++i) {
    const double a = points(i, 0), b = points(i, 1);
    for (int k = 0; k < kNumbers; ++k) {
      const double bent = (k % 3 - 1) * (a * a * a - b * a * b);
      out.numbers(i, k) = a + (k % 2 == 0 ? b : -b) + 0.5 * bent + 0.1 * draw_of(i, 200 + k, trial);
    }
  }
  return out;
}

// 200 intervals of 95 % hold with a deviation of 1.5 %.
TEST(CrossFit, experimentsAtTheAnswerSharpenIt) {
  double before = 0, after = 0;
  int held = 0;
  constexpr int kTrials = 100;
  const Prior wide{Vector::Zero(2), Vector::Constant(2, 10)};
  for (int i = 0; i < kTrials; ++i) {
    const auto trial = static_cast<std::uint64_t>(1000 + i);
    const Design design = curved(simulated(80, trial).points, trial);
    const Vector truth = 0.4 * simulated(1, trial + 500).points.row(0).transpose();
    const Vector data = curved(truth.transpose(), trial + 500).numbers.row(0);
    const InverseRegression first = inverse_regression(design, Vector::Zero(2), wide, data);
    const Vector& at = first.answer.estimate;
    const Matrix there = curved(at.transpose().replicate(60, 1), trial + 1000).numbers;
    const ParameterEstimate sharp = anchored(first, design, at, there, wide, data).answer;
    before += (at - truth).squaredNorm(), after += (sharp.estimate - truth).squaredNorm();
    for (int k = 0; k < 2; ++k) {
      const double half = sharp.wide * sharp.deviation(k);
      held += std::fabs(sharp.estimate(k) - truth(k)) < half ? 1 : 0;
    }
  }
  const double ideal = kTrials * 2 * 0.1 * 0.1 / kNumbers;  // by least squares
  EXPECT_GT(before, 2 * ideal);
  EXPECT_LT(after, 1.5 * ideal);
  EXPECT_GT(held, 0.91 * 2 * kTrials);
}

}  // namespace
}  // namespace lilytank
