// Inverse regression of estimates on known parameters.
#include "calibrate/estimate_line.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

double normal_of(std::int64_t row, std::uint32_t column, std::uint32_t what) {
  return normal_pair({11, Stream::calibrate, row, column, what})[0];
}

// Answers that are drawn half-way to the centre and mixed, with a little noise.
struct Replicates {
  Matrix off, answers;
};
Replicates replicates(int count, double noise) {
  Matrix mix(2, 2);
  mix << 0.5, 0.1, -0.2, 0.6;
  Replicates out{Matrix(count, 2), Matrix(count, 2)};
  for (int i = 0; i < count; ++i) {
    const Vector off = (Vector(2) << normal_of(i, 0, 1), normal_of(i, 1, 1)).finished();
    const Vector scatter = (Vector(2) << normal_of(i, 0, 2), normal_of(i, 1, 2)).finished();
    out.off.row(i) = off;
    out.answers.row(i) = (Vector(2) << 3, 4).finished() + mix * off + noise * scatter;
  }
  return out;
}

// Where answers have no noise, what was known before does not matter.
TEST(EstimateLine, answersWithoutNoiseAreTheTruth) {
  const Replicates r = replicates(20, 0);
  const Line line = line_through(r.off, r.answers);
  Vector centre(2), off(2);
  centre << 10, 20, off << 0.7, -1.3;
  const Vector answer = line.at_centre + line.slope * off;
  const Prior prior{centre, Vector::Ones(2)};
  EXPECT_LT((estimate_of(line, centre, answer, prior).estimate - centre - off).norm(), 1e-6);
}

// One parameter, answers s theta + e: the normal law's mean and variance given an answer.
TEST(EstimateLine, withPriorIsTheNormalLawGivenTheAnswer) {
  Line line;
  line.at_centre = Vector::Constant(1, 2), line.slope = Matrix::Constant(1, 1, 0.4);
  line.covariance = Matrix::Constant(1, 1, 0.09), line.inverse = Matrix::Zero(2, 2);
  line.freedom = 1e9;
  const Prior prior{Vector::Constant(1, 0.3), Vector::Constant(1, 1.5)};
  const ParameterEstimate s = estimate_of(line, Vector::Zero(1), Vector::Constant(1, 2.5), prior);
  const double before = 2.25, answers = 0.16 * before + 0.09;
  EXPECT_NEAR(s.estimate(0), 0.3 + before * 0.4 * (0.5 - 0.4 * 0.3) / answers, 1e-12);
  EXPECT_NEAR(s.deviation(0), std::sqrt(before * 0.09 / answers), 1e-12);
  EXPECT_NEAR(s.wide, 1.96, 1e-3);
}

// Lines from thirty replicates; 2000 intervals of 95 % hold with a deviation of 0.5 %, and the line
// itself is known to a few per cent only.
TEST(EstimateLine, intervalsHoldTheTruth) {
  const Replicates r = replicates(30, 0.3);
  const Line line = line_through(r.off, r.answers);
  const Replicates fresh = replicates(2030, 0.3);
  int held = 0;
  for (int i = 30; i < 2030; ++i) {
    const Vector answer = fresh.answers.row(i);
    const ParameterEstimate s =
        estimate_of(line, Vector::Zero(2), answer, {Vector::Zero(2), Vector::Ones(2)});
    held += std::fabs(s.estimate(0) - fresh.off(i, 0)) < s.wide * s.deviation(0) ? 1 : 0;
  }
  EXPECT_NEAR(held / 2000.0, 0.95, 0.035);
}

}  // namespace
}  // namespace lilytank
