// The parts that flow estimates are made of.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "flow/balances.hpp"
#include "flow/gust_fit.hpp"
#include "flow/gusted_drag.hpp"
#include "flow/node_grid.hpp"
#include "flow/selected_inverse.hpp"
#include "support/tracks.hpp"

namespace lilytank {
namespace {

using test::recording_of;

// Means over the plane of both normals by a plain sum.
struct Sum {
  double x = 0, xx = 0, yy = 0;
};
Sum by_summing(double u, double s) {
  constexpr int kPoints = 400;
  constexpr double kReach = 7.5, kStep = 2 * kReach / kPoints;
  Sum out;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const double p = -kReach + (i + 0.5) * kStep, q = -kReach + (j + 0.5) * kStep;
      const double weight = kStep * kStep / (2 * kPi) * std::exp(-(p * p + q * q) / 2);
      const double wx = u + s * p, wy = s * q, w = std::hypot(wx, wy);
      out.x += weight * w * wx;
      out.xx += weight * w * wx * w * wx, out.yy += weight * w * wy * w * wy;
    }
  }
  out.xx -= out.x * out.x;
  return out;
}

TEST(gustedDrag, meanAndCovarianceAreThoseOfASum) {
  const GustedDrag drag;
  const double s = 0.05;
  for (const double u : {0.0, 0.003, 0.04, 0.13, 0.5, 0.81}) {
    const Sum expected = by_summing(u, s);
    const auto mean = drag.mean(u, 0, s * s);
    const auto spread = drag.moments(u, 0, s * s).covariance;
    EXPECT_NEAR(mean.x, expected.x, 1e-6 * (u * u + s * s)) << u;
    EXPECT_NEAR(spread.xx, expected.xx, 1e-5 * expected.xx) << u;
    EXPECT_NEAR(spread.yy, expected.yy, 1e-5 * expected.yy) << u;
  }
}

TEST(gustedDrag, derivativesAreThose) {
  const GustedDrag drag;
  for (const double u : {0.01, 0.1, 0.3, 0.9}) {
    const double ux = 0.6 * u, uy = -0.8 * u, s2 = 0.0025, e = 1e-5;
    const auto at = drag.mean(ux, uy, s2);
    const auto right = drag.mean(ux + e, uy, s2), left = drag.mean(ux - e, uy, s2);
    const auto more = drag.mean(ux, uy, s2 * std::exp(e)),
               less = drag.mean(ux, uy, s2 * std::exp(-e));
    EXPECT_NEAR(at.xx, (right.x - left.x) / (2 * e), 2e-5) << u;
    EXPECT_NEAR(at.xy, (right.y - left.y) / (2 * e), 2e-5) << u;
    EXPECT_NEAR(at.sy, (more.y - less.y) / (2 * e), 2e-5) << u;
    const auto c = drag.moments(ux, uy, s2).covariance,
               d = drag.moments(ux, uy, s2 * std::exp(e)).covariance;
    EXPECT_NEAR(c.sxy, (d.xy - c.xy) / e, 1e-3 * std::fabs(c.xy)) << u;
    EXPECT_NEAR(c.syy, (d.yy - c.yy) / e, 1e-3 * c.yy) << u;
  }
}

TEST(gustedDrag, withoutGustsItIsTheSquare) {
  const auto m = GustedDrag().mean(0.3, 0.4, 1e-10);
  EXPECT_NEAR(m.x, 0.5 * 0.3, 1e-8);
  EXPECT_NEAR(m.y, 0.5 * 0.4, 1e-8);
}

TEST(selectedInverse, agreesWithTheWholeInverse) {
  // A random band matrix with a few far entries.
  constexpr int kSize = 60;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(kSize, kSize);
  for (int i = 0; i < kSize; ++i) {
    for (const int j : {i + 1, i + 3, (7 * i) % kSize}) {
      if (j >= kSize || j == i) continue;
      a(i, j) = a(j, i) = test::normal(1, i, j);
    }
  }
  a.diagonal() = a.cwiseAbs().rowwise().sum();
  a.diagonal().array() += 0.5;
  const SparseFactor factor(Eigen::SparseMatrix<double>(a.sparseView()));
  const SelectedInverse selected(factor);
  const Eigen::MatrixXd whole = a.inverse();
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) {
      if (a(i, j) == 0) continue;
      EXPECT_NEAR(selected(i, j), whole(i, j), 1e-12) << i << "," << j;
    }
  }
}

TEST(nodeGrid, stencilsReproducePlaneFieldsAndRoughnessIgnoresThem) {
  const FlowGrid grid{50, 0.3};
  const NodeGrid nodes(grid, 0.3);
  Eigen::VectorXd plane(nodes.size());
  for (int n = 0; n < nodes.size(); ++n) plane[n] = 2 + 3 * nodes.x(n) - 5 * nodes.y(n);
  for (int k = 0; k < 200; ++k) {
    const double r = 0.285 * std::sqrt(k / 200.0), x = r * std::cos(k), y = r * std::sin(k);
    const Stencil s = nodes.stencil(x, y);
    double value = 0;
    for (std::size_t i = 0; i < 4; ++i) value += s.weight[i] * plane[s.node[i]];
    EXPECT_NEAR(value, 2 + 3 * x - 5 * y, 1e-12);
  }
  EXPECT_NEAR(plane.dot(nodes.roughness() * plane), 0, 1e-9);
}

TEST(nodeGrid, splinesSumToOne) {
  const NodeGrid nodes({50, 0.3}, 0.3);
  const Eigen::VectorXd one = nodes.splines(0.1).rowwise().sum();
  const Eigen::VectorXd round = nodes.radial_splines(0.075).rowwise().sum();
  EXPECT_NEAR((one.array() - 1).abs().maxCoeff(), 0, 1e-12);
  EXPECT_NEAR((round.array() - 1).abs().maxCoeff(), 0, 1e-12);
}

TEST(gustFit, littleInformationLeavesWhatWasKnown) {
  const Eigen::Index n = 5;
  const GustPosterior p = gust_posterior(Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 3);
  EXPECT_NEAR(p.mean.norm(), 0, 1e-12);
  EXPECT_GT(p.covariance(0, 0), 1);
}

TEST(gustFit, muchInformationIsBelieved) {
  const Eigen::VectorXd truth = (Eigen::VectorXd(4) << 0.3, -0.2, 0.5, 0.1).finished();
  const Eigen::MatrixXd information = 1e6 * Eigen::MatrixXd::Identity(4, 4);
  const GustPosterior p = gust_posterior(information, information * truth, 4);
  EXPECT_LT((p.mean - truth).norm(), 1e-3);
  EXPECT_NEAR(p.covariance(1, 1), 1e-6, 1e-7);
}

BallPhysics ball() {
  return {};
}

TEST(balances, aSteadyAccelerationIsExact) {
  const Recording r = recording_of(1, 60, 30, [](int, int f) {
    const double t = f / 30.0;
    return std::array{-0.1 + 0.1 * t - 0.02 * t * t, 0.05 * t};
  });
  const TrackNoise noise{0, 0.02};
  const BalanceSet set = find_balances(r, ball(), balance_shape(30, noise, kTick), noise);
  ASSERT_GT(set.balances.size(), 10u);
  for (const Balance& b : set.balances) {
    EXPECT_NEAR(b.ax, -0.04, 1e-9);
    EXPECT_NEAR(b.ay, 0, 1e-9);
    EXPECT_NEAR(b.vy0, 0.05, 1e-9);
  }
}

TEST(balances, contactsAndTheWallAreLeftOut) {
  // Two balls that pass at 4 cm, and two that meet; one that runs into the wall.
  const auto towards = [](double gap) {
    return recording_of(2, 90, 30, [gap](int b, int f) {
      const double s = (b == 0 ? 1 : -1) * (0.1 - 0.1 * f / 45.0);
      return std::array{s, b == 0 ? 0.0 : gap};
    });
  };
  const TrackNoise noise{0, 0.02};
  const BalanceShape shape = balance_shape(30, noise, kTick);
  EXPECT_EQ(find_balances(towards(0.05), ball(), shape, noise).dropped, 0);
  const BalanceSet meeting = find_balances(towards(0.0), ball(), shape, noise);
  EXPECT_GT(meeting.dropped, 10);
  for (const Balance& b : meeting.balances) EXPECT_GT(std::fabs(b.at - 45), 4);
  const Recording wall = recording_of(1, 60, 30, [](int, int f) {
    return std::array{0.2 + 0.1 * f / 59.0, 0.0};
  });
  EXPECT_GT(find_balances(wall, ball(), shape, noise).dropped, 2);
}

TEST(balances, gapsAndShortTracksAreSkipped) {
  Recording r = recording_of(1, 40, 30, [](int, int f) { return std::array{0.001 * f, 0.0}; });
  r.tracks[0].x[20] = r.tracks[0].y[20] = test::kUnseen;
  const TrackNoise noise{0, 0.02};
  const BalanceShape shape = balance_shape(30, noise, kTick);
  for (const Balance& b : find_balances(r, ball(), shape, noise).balances) {
    EXPECT_TRUE(b.at - shape.lead() > 20 || b.at + shape.tail() < 20) << b.at;
    EXPECT_NEAR(b.ax, 0, 1e-9);
  }
  r.frames = 5, r.tracks[0].x.resize(5), r.tracks[0].y.resize(5);
  EXPECT_TRUE(find_balances(r, ball(), shape, noise).balances.empty());
}

// A ball under held random forces alone, seen with noise: kicks and noise come back.
TEST(balances, noiseAndKicksAreTold) {
  constexpr double kNoise = 0.0004, kForce = 0.5;  // m, m/s^2
  constexpr int kFine = 200;                       // steps per second; forces are held for 5
  std::array<double, 2> x{}, v{}, a{};
  int step = 0;
  const Recording r = recording_of(40, 1200, 30, [&](int b, int f) {
    if (f == 0) x = {}, v = {}, step = 0;
    for (; step * 30 < f * kFine; ++step) {
      for (std::size_t i = 0; i < 2; ++i) {
        if (step % 5 == 0) a[i] = kForce * test::normal(5, step, b, static_cast<std::uint32_t>(i));
        x[i] += v[i] / kFine + a[i] / (2.0 * kFine * kFine), v[i] += a[i] / kFine;
      }
    }
    const double late = f / 30.0 - static_cast<double>(step) / kFine;
    return std::array{x[0] + late * v[0] + kNoise * test::normal(6, f, b, 0),
                      x[1] + late * v[1] + kNoise * test::normal(6, f, b, 1)};
  });
  const TrackNoise found = track_noise({&r, 1}, 30, 0.025);
  // 96,000 sightings of which about a fifth are independent: 1 % each, and 2 % by the clocks' beat.
  EXPECT_NEAR(found.kick / (kForce * kForce * 0.025), 1, 0.05);
  EXPECT_NEAR(std::sqrt(found.variance) / kNoise, 1, 0.05);
}

}  // namespace
}  // namespace lilytank
