// Eq. 3 where it is exact, what a cell holds, and files.
#include "lilytank/flow_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/flow_report.hpp"
#include "support/flow_tank.hpp"
#include "support/temporary_directory.hpp"
#include "support/tracks.hpp"

namespace lilytank {
namespace {

using test::recording_of;

FlowOptions few_samples() {
  FlowOptions options;
  options.least_samples = 5;
  return options;
}

// A ball on a circle of radius r at speed v: a = v^2 / r inwards, so by Eq. 3 the water goes round
// with v and inwards with sqrt(m a / (rho A C / 2)).
TEST(paperEstimate, circlesGiveTheFlowOfEq3) {
  const double radius = 0.123, speed = 0.2;
  const Recording r = recording_of(1, 3000, 30, [&](int, int f) {
    const double angle = speed / radius * f / 30.0;
    return std::array{radius * std::cos(angle), radius * std::sin(angle)};
  });
  const BallPhysics ball;
  FlowOptions options;
  options.smoothing.window = 0.2;
  const FlowEstimate e = estimate_paper({&r, 1}, ball, options);
  const double a = speed * speed / radius;
  const double inward = std::sqrt(ball.mass * a / (0.5 * 1000 * 7e-4 * 0.47));
  int seen = 0;
  for (std::size_t i = 0; i < e.cell.size(); ++i) {
    if (!e.cell[i].measured) continue;
    ++seen;
    // A cell sees the circle over up to 17 mm of its length: the direction turns by 0.14.
    const double x = e.x(static_cast<int>(i)), y = e.y(static_cast<int>(i)), d = std::hypot(x, y);
    const FlowSample& f = e.cell[i].flow;
    EXPECT_NEAR((f.mu_y * x - f.mu_x * y) / d, speed, 0.02);
    EXPECT_NEAR(-(f.mu_x * x + f.mu_y * y) / d, inward, 0.02);
  }
  EXPECT_GT(seen, 40);
}

TEST(paperEstimate, cellsHoldMeanDeviationAndCount) {
  // Straight flight at three speeds through the middle row: no acceleration, so water = ball.
  const Recording r = recording_of(3, 301, 100, [](int b, int f) {
    return std::array{-0.15 + (0.08 + 0.02 * b) * f / 100.0, 0.006};
  });
  const FlowEstimate e = estimate_paper({&r, 1}, BallPhysics(), {});
  const FlowCell& c = e.cell[25 * 50 + 14];  // x from -0.132 to -0.120
  ASSERT_TRUE(c.measured);
  EXPECT_EQ(c.stays, 3);
  // Frames in the cell: 15, 12 and 10, give or take one at the edges.
  EXPECT_NEAR(c.samples, 37, 3);
  EXPECT_NEAR(c.flow.mu_x, (15 * 0.08 + 12 * 0.10 + 10 * 0.12) / 37, 0.002);
  EXPECT_NEAR(c.flow.mu_y, 0, 1e-5);
  EXPECT_NEAR(c.flow.sigma_x, 0.0165, 0.001);
  EXPECT_FALSE(e.cell[0].measured);
  EXPECT_EQ(e.samples, 903);
}

TEST(paperEstimate, cellsWithoutDataAreFilledFromThoseAround) {
  const Recording r = recording_of(2, 301, 100, [](int b, int f) {
    return std::array{-0.15 + 0.1 * f / 100.0, b == 0 ? 0.03 : -0.03};
  });
  const FlowEstimate e = estimate_paper({&r, 1}, BallPhysics(), few_samples());
  const FlowCell& between = e.cell[25 * 50 + 20];
  EXPECT_FALSE(between.measured);
  EXPECT_NEAR(between.flow.mu_x, 0.1, 0.001);
}

TEST(flowEstimate, recordingsWithoutBallsAreRefused) {
  Recording r = recording_of(1, 100, 30, [](int, int f) { return std::array{0.001 * f, 0.0}; });
  r.body = BodyKind::lily;
  EXPECT_THROW(estimate_paper({&r, 1}, BallPhysics(), {}), InputError);
  EXPECT_THROW(estimate_smooth({&r, 1}, BallPhysics(), {}), InputError);
  r.body = BodyKind::ball;
  EXPECT_THROW(estimate_smooth({&r, 1}, BallPhysics(), {}), InputError);  // too short
  BallPhysics massless;
  massless.mass = 0;
  EXPECT_THROW(estimate_paper({&r, 1}, massless, {}), InputError);
  FlowOptions coarse;
  coarse.cells = 1;
  EXPECT_THROW(estimate_paper({&r, 1}, BallPhysics(), coarse), InputError);
}

TEST(flowEstimate, physicsComeFromTheModel) {
  Model m = standard_model();
  m.ball.mass = 0.02, m.tank.radius = 0.4;
  ActiveForce drag = with_defaults(*find_force("ball_drag"));
  drag.p = {0.6, 7};
  ActiveForce damping = with_defaults(*find_force("damping"));
  damping.p[0] = 0.5;
  m.forces = {drag, damping};
  const BallPhysics ball = ball_physics(m);
  EXPECT_EQ(ball.mass, 0.02);
  EXPECT_EQ(ball.tank_radius, 0.4);
  EXPECT_EQ(ball.drag_coefficient, 0.6);
  EXPECT_EQ(ball.draws, 7);
  EXPECT_NEAR(ball.damping, std::log(2.0), 1e-15);
}

TEST(flowFiles, aRunReadsTheGrid) {
  const Recording r = recording_of(3, 301, 100, [](int b, int f) {
    return std::array{-0.15 + 0.1 * f / 100.0, 0.03 * b};
  });
  FlowReport report;
  report.name = "three";
  report.estimates.push_back(estimate_paper({&r, 1}, report.ball, few_samples()));
  const TemporaryDirectory dir;
  write_flow(report, flow_report(report), dir.path("out"));
  const FlowField field = read_flow_csv(dir.path("out/flow_paper.csv"), Interpolation::bilinear);
  const FlowField own = field_of(report.estimates[0], Interpolation::bilinear);
  EXPECT_EQ(field.measured(), own.measured());
  for (std::size_t i = 0; i < own.samples().size(); ++i) {
    ASSERT_NEAR(field.samples()[i].mu_x, own.samples()[i].mu_x, 1e-6);
    ASSERT_NEAR(field.samples()[i].sigma_y, own.samples()[i].sigma_y, 1e-6);
  }
  // Its own truth: no error.
  const FlowTruth truth = read_flow_truth(dir.path("out/flow_paper.csv"), 50);
  const FlowError error = compare_flow(report.estimates[0], truth, false);
  EXPECT_EQ(error.cells, report.estimates[0].measured());
  EXPECT_LT(error.mean_rms, 1e-6);
  EXPECT_THROW(read_flow_truth(dir.path("out/flow_paper.csv"), 40), InputError);
}

TEST(flowFiles, errorsHaveTheirSigns) {
  FlowEstimate e;
  e.cells = 4, e.extent = 0.4;
  e.cell.resize(16);
  FlowTruth truth{4, std::vector<FlowSample>(16)};
  for (std::size_t i = 0; i < 16; ++i) {
    // 0.1 outwards and 0.02 round, seen in a truth at rest.
    const double x = e.x(static_cast<int>(i)), y = e.y(static_cast<int>(i)), r = std::hypot(x, y);
    e.cell[i].flow = {(0.1 * x - 0.02 * y) / r, (0.1 * y + 0.02 * x) / r, 0.03, 0.03};
    e.cell[i].error = {0.2, 0.2, 0.001, 0.001};
    e.cell[i].measured = i % 2 == 0;
  }
  const FlowError error = compare_flow(e, truth, true);
  EXPECT_EQ(error.cells, 8);
  EXPECT_NEAR(error.mean_radial, 0.1, 1e-12);
  EXPECT_NEAR(error.mean_around, 0.02, 1e-12);
  EXPECT_NEAR(error.mean_rms, std::hypot(0.1, 0.02) / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(error.deviation_bias, 0.03, 1e-12);
  EXPECT_EQ(error.mean_coverage, 1);
  EXPECT_EQ(error.deviation_coverage, 0);
  truth.sample[0].mu_x = std::nan("");
  EXPECT_EQ(compare_flow(e, truth, true).cells, 7);
}

}  // namespace
}  // namespace lilytank
